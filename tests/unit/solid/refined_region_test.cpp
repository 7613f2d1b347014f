// Proves that the boxes of splits, and the rectangles between them, have the components that cutting the solid by their
// sides gives. All of them pass.
#include "solid/model/refined_region.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "blum/shapes/shape_catalog.hpp"
#include "blum/solid/solid.hpp"
#include "solid/model/cut_grid.hpp"
#include "solid/model/model_regions.hpp"
#include "support/model_solids.hpp"
#include "support/slow_clipping.hpp"

namespace blum::detail {
namespace {

struct Found {
  std::size_t boxes = 0;
  std::size_t split_boxes = 0;
  std::size_t rectangles = 0;
  std::size_t in_parts = 0;  ///< sides of boxes with several rectangles
  std::size_t several = 0;   ///< boxes with several components
  std::size_t unsure = 0;
  std::size_t finer = 0;  ///< boxes with vertices that must be small
};

test::SolidPart cut_to(test::SolidPart part, const Vec3d& low, const Vec3d& high, std::size_t axis) {
  part = test::cut_by_plane(part, axis, low[axis], true);
  return test::cut_by_plane(part, axis, high[axis], false);
}

class RegionCheck {
 public:
  RegionCheck(const TriangleMesh& mesh, const RefinedRegion& region, std::string name, Found& found)
      : whole_(test::whole_solid(mesh)), region_(region), name_(std::move(name)), found_(found) {
    EXPECT_TRUE(region.stuck().empty()) << name_;
    for (std::uint32_t b = 0; b < region.boxes().size(); ++b) check_box(b);
    found_.split_boxes += region.split_boxes();
  }

 private:
  void check_box(std::uint32_t b) {
    const BoxCell& box = region_.boxes()[b];
    test::SolidPart part = whole_;
    for (std::size_t a = 0; a < 3; ++a) part = cut_to(part, box.low, box.high, a);
    const test::PartShape shape = test::shape_of(part, box.high);
    ++found_.boxes;
    if (!shape.is_sure) {
      ++found_.unsure;
      return;
    }
    EXPECT_EQ(shape.voids, 0U) << name_ << " box " << b;
    for (const int euler : shape.shells) EXPECT_EQ(euler, 2) << name_ << " box " << b;
    EXPECT_EQ(region_.components_of_box(b), shape.components) << name_ << " box " << b;
    if (shape.components > 1) ++found_.several;
    std::array<std::size_t, 6> rectangles{};
    for (std::uint32_t r = 0; r < region_.cells().rectangles().size(); ++r) {
      const BoxRectangle& rectangle = region_.cells().rectangles()[r];
      for (std::size_t above = 0; above < 2; ++above) {
        if (rectangle.boxes[1 - above] != BoxRef{b, true}) continue;
        const std::size_t side = 2 * rectangle.axis + above;
        ++rectangles[side];
        check_rectangle(r, part, box, side);
      }
    }
    for (const std::size_t count : rectangles) {
      EXPECT_GE(count, 1U);
      if (count > 1) ++found_.in_parts;
    }
  }

  /// @param side  the side of the box that contains the rectangle.
  void check_rectangle(std::uint32_t r, test::SolidPart part, const BoxCell& box, std::size_t side) {
    const BoxRectangle& rectangle = region_.cells().rectangles()[r];
    const auto corner = [&](std::uint32_t segment, std::size_t end) {
      return region_.cells().corners()[region_.cells().segments()[segment].ends[end]];
    };
    const Vec3d low = corner(rectangle.sides[0].front(), 0);
    Vec3d high = corner(rectangle.sides[1].back(), 1);
    for (std::size_t a = 0; a < 3; ++a) {
      if (a != rectangle.axis && (low[a] > box.low[a] || high[a] < box.high[a])) part = cut_to(part, low, high, a);
    }
    high[rectangle.axis] = box.high[rectangle.axis];
    const test::PartShape shape = test::shape_of(part, high);
    ++found_.rectangles;
    if (!shape.is_sure) {
      ++found_.unsure;
      return;
    }
    for (const int euler : shape.sides[side]) EXPECT_EQ(euler, 1) << name_ << " rectangle " << r;
    EXPECT_EQ(region_.components_of_rectangle(r), shape.sides[side].size()) << name_ << " rectangle " << r;
  }

  test::SolidPart whole_;
  const RefinedRegion& region_;
  std::string name_;
  Found& found_;
};

/// The part of the box around a body in which regions must be finer.
Box3 wanted_finer(const Box3& box) {
  return {box.lower + 0.2 * box.size(), box.lower + 0.5 * box.size()};
}

/// Checks that boxes are as small as requested if they overlap the finer part and contain a vertex of the mesh.
void expect_finer(const TriangleMesh& mesh, const RefinedRegion& region, const Box3& finer, Found& found) {
  const Vec3d size = finer.size();
  for (std::size_t b = 0; b < region.boxes().size(); ++b) {
    const BoxCell& box = region.boxes()[b];
    const Vec3d apart = min(box.high, finer.upper) - max(box.low, finer.lower);
    const bool has_vertex = std::any_of(mesh.vertices.begin(), mesh.vertices.end(),
                                        [&](const Vec3d& v) { return max(box.low, min(box.high, v)) == v; });
    if (!(apart.x > 0 && apart.y > 0 && apart.z > 0) || !has_vertex) continue;
    ++found.finer;
    const Vec3d own = box.high - box.low;
    EXPECT_LE(std::max({own.x, own.y, own.z}), 0.3 * std::max({size.x, size.y, size.z}));
  }
}

void check(const test::NamedMesh& named, const std::vector<int>& resolutions, bool is_finer, Found& found) {
  const Solid solid = Solid::of(named.mesh);
  if (solid.rule() != SolidRule::polyhedron) return;
  const Vec3d size = solid.box().size();
  for (const int resolution : resolutions) {
    const double spacing = std::max({size.x, size.y, size.z}) / resolution;
    const Vec3d origin = solid.box().lower - Vec3d{0.31, 0.45, 0.57} * spacing;
    for (const SolidBody& body : solid.bodies()) {
      const SurfaceMesh surface(body.mesh, {});
      const CutGrid grid(surface, test::planes_around(body.mesh, origin, spacing, 2), {});
      std::vector<Box3> finer;
      if (is_finer) finer.push_back(wanted_finer(bounds(body.mesh)));
      for (const RefinedRegion& region : refine_regions(surface, grid, 60, finer, {})) {
        RegionCheck(body.mesh, region, named.name + " at " + std::to_string(resolution), found);
        if (is_finer) expect_finer(body.mesh, region, finer.front(), found);
      }
    }
  }
}

TEST(RefinedRegion, BoxesPassAndHaveTheComponentsOfASlowClipping) {
  Found found;
  for (const test::NamedMesh& named : test::thin_solids()) check(named, {1, 2, 5}, false, found);
  for (const char* name : {"plate", "menger", "torus", "void_cube", "gear", "nested_shells", "bracket"}) {
    const ShapeInfo& shape = find_shape(name);
    const TriangleMesh mesh = shape.make(complete_parameters(shape, {}));
    if (mesh.triangles.size() < 7000) check({name, test::turned(mesh, 5)}, {1, 2}, false, found);
  }
  EXPECT_EQ(found.unsure, 0U);
  EXPECT_GT(found.boxes, 1000U);
  EXPECT_GT(found.split_boxes, 400U);
  EXPECT_GT(found.rectangles, 5000U);
  EXPECT_GT(found.in_parts, 300U);
  EXPECT_GT(found.several, 30U);
}

TEST(RefinedRegion, IsAsFineAsRequestedAndPasses) {
  Found found;
  for (const test::NamedMesh& named : test::thin_solids()) check(named, {2, 5}, true, found);
  EXPECT_EQ(found.unsure, 0U);
  EXPECT_GT(found.finer, 100U);
}

}  // namespace
}  // namespace blum::detail
