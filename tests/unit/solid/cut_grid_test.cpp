// Proves that the components that tracing finds in the cells of a grid equal those of a test of every triangle in every
// cell. Vertices, edges and faces may lie in planes of the grid.
#include "solid/model/cut_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/geometry/grid_predicates.hpp"
#include "blum/geometry/orient3d.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/solid/solid.hpp"
#include "solid/model/refined_region.hpp"
#include "support/model_solids.hpp"

namespace blum::detail {
namespace {

struct Found {
  std::size_t cut_cubes = 0;
  std::size_t failing = 0;
  std::size_t crossings = 0;
  std::size_t several = 0;  ///< cubes with several components
};

/// Compares a grid with one region of all its cubes except the outermost. None of the cubes is split.
class Comparison {
 public:
  Comparison(const SurfaceMesh& mesh, const GridPlanes& planes, std::string name, Found& found)
      : mesh_(mesh), grid_(mesh, planes, {}), name_(std::move(name)), found_(found), region_(whole_region()) {}

  void run() {
    compare_nodes();
    compare_segments();
    compare_rectangles();
    find_doubtful();
    compare_boxes();
  }

 private:
  [[nodiscard]] RefinedRegion whole_region() const {
    std::vector<Cell> cubes;
    const auto& size = grid_.lattice().size();
    for (std::size_t node = 0; node < grid_.lattice().node_count(); ++node) {
      const auto at = grid_.lattice().place(node);
      bool is_inner = true;
      for (std::size_t a = 0; a < 3; ++a) is_inner = is_inner && at[a] > 0 && at[a] + 2 < size[a];
      if (is_inner) cubes.push_back(cell_at(node, 7));
    }
    std::vector<std::uint32_t> all(mesh_.triangles().size());
    std::iota(all.begin(), all.end(), 0U);
    return {mesh_, grid_, cubes, std::vector(cubes.size(), all), 0, {}, {}};
  }

  [[nodiscard]] std::size_t node_at(const Vec3d& p) const {
    const Place at = grid_.planes().cube(p);
    return grid_.lattice().node(at[0], at[1], at[2]);
  }
  [[nodiscard]] Cell edge_of(std::uint32_t segment) const {
    const BoxSegment& s = region_.cells().segments()[segment];
    return cell_at(node_at(region_.cells().corners()[s.ends[0]]), 1U << s.axis);
  }
  [[nodiscard]] Cell square_of(std::uint32_t rectangle) const {
    const BoxRectangle& r = region_.cells().rectangles()[rectangle];
    return cell_at(node_of(edge_of(r.sides[0].front())), 7U ^ (1U << r.axis));
  }

  /// A node is inside if a line along an axis crosses the surface below it an odd number of times.
  void compare_nodes() {
    const GridPlanes& planes = grid_.planes();
    for (std::size_t node = 0; node < grid_.lattice().node_count(); ++node) {
      const auto at = grid_.lattice().place(node);
      const Vec3d p = planes.node(
          {static_cast<std::int32_t>(at[0]), static_cast<std::int32_t>(at[1]), static_cast<std::int32_t>(at[2])});
      const std::size_t axis = node % 3;
      int below = 0;
      for (std::uint32_t t = 0; t < mesh_.triangles().size(); ++t) below += is_below(t, p, axis) ? 1 : 0;
      ASSERT_EQ(grid_.is_inside(node), below % 2 == 1) << name_ << " node " << node;
    }
  }
  [[nodiscard]] bool is_below(std::uint32_t triangle, const Vec3d& p, std::size_t axis) const {
    const TriangleCorners t = mesh_.corners(triangle);
    const double u = p[(axis + 1) % 3];
    const double v = p[(axis + 2) % 3];
    const int first = side_of_line({t[0], t[1]}, axis, u, v);
    return first != 0 && first == side_of_line({t[1], t[2]}, axis, u, v) &&
           first == side_of_line({t[2], t[0]}, axis, u, v) && side_of_node(t, p) == first;
  }

  void compare_segments() {
    for (std::uint32_t s = 0; s < region_.cells().segments().size(); ++s) {
      const Cell edge = edge_of(s);
      const auto crossings = region_.crossings(s);
      ASSERT_EQ(region_.components_of_segment(s), grid_.components(edge)) << name_ << " edge " << edge;
      const auto traced = grid_.crossings(edge);
      ASSERT_TRUE(std::equal(crossings.begin(), crossings.end(), traced.begin(), traced.end()))
          << name_ << " edge " << edge;
      found_.crossings += crossings.size();
    }
  }

  void compare_rectangles() {
    for (std::uint32_t r = 0; r < region_.cells().rectangles().size(); ++r) {
      const Cell square = square_of(r);
      ASSERT_EQ(region_.components_of_rectangle(r), grid_.components(square)) << name_ << " square " << square;
      const auto& sides = region_.cells().rectangles()[r].sides;
      for (std::size_t k = 0; k < 4; ++k) {
        ASSERT_EQ(sides[k].size(), 1U);
        const Cell side = edge_of(sides[k].front());
        ASSERT_EQ(side, grid_.sides_of(square)[k]);
        for (std::uint32_t i = 0; i < grid_.components(side); ++i) {
          ASSERT_EQ(region_.component_of_interval(r, sides[k].front(), i), grid_.component_of_interval(square, side, i))
              << name_ << " square " << square;
        }
      }
    }
  }

  /// The region names one of the two cubes at a square with a hole. The components of both are unknown.
  void find_doubtful() {
    std::set<Cell> stuck;
    for (const StuckBox& box : region_.stuck()) {
      stuck.insert(box.box.cube);
      ASSERT_TRUE(is_failing(box.box.cube)) << name_ << " cube " << box.box.cube;
      if (box.obstacle != ModelObstacle::hole_in_square && box.obstacle != ModelObstacle::slanted_needle) continue;
      doubtful_.insert(box.box.cube);
      grid_.lattice().for_each_face(box.box.cube, [&](Cell face) {
        grid_.lattice().for_each_coface(face, [&](Cell cube) { doubtful_.insert(cube); });
      });
    }
    for (const Cell cube : grid_.failing_cubes()) {
      ASSERT_TRUE(stuck.contains(cube) || doubtful_.contains(cube)) << name_ << " cube " << cube;
    }
    found_.failing += grid_.failing_cubes().size();
  }
  [[nodiscard]] bool is_failing(Cell cube) const {
    return std::binary_search(grid_.failing_cubes().begin(), grid_.failing_cubes().end(), cube);
  }

  void compare_boxes() {
    std::map<Cell, std::uint32_t> rectangles;
    for (std::uint32_t r = 0; r < region_.cells().rectangles().size(); ++r) rectangles[square_of(r)] = r;
    for (std::uint32_t b = 0; b < region_.boxes().size(); ++b) {
      const Cell cube = region_.boxes()[b].cube;
      if (grid_.is_cut(cube)) ++found_.cut_cubes;
      if (is_failing(cube) && (doubtful_.contains(cube) || !grid_.shells_in(cube).empty())) continue;
      ASSERT_EQ(region_.components_of_box(b), grid_.components(cube)) << name_ << " cube " << cube;
      if (grid_.components(cube) > 1) ++found_.several;
      ASSERT_EQ(region_.bodies_in(b).size(), grid_.shells_in(cube).size()) << name_ << " cube " << cube;
      const auto faces = grid_.faces_of(cube);
      std::map<std::uint32_t, std::uint32_t> there;
      std::map<std::uint32_t, std::uint32_t> back;
      for (std::size_t f = 0; f < 6; ++f) {
        for (std::uint32_t part = 0; part < grid_.components(faces[f]); ++part) {
          const std::uint32_t traced = grid_.component_of_part(cube, f, part);
          const std::uint32_t tried = region_.component_of_part(b, rectangles.at(faces[f]), part);
          ASSERT_EQ(there.try_emplace(traced, tried).first->second, tried) << name_ << " cube " << cube;
          ASSERT_EQ(back.try_emplace(tried, traced).first->second, traced) << name_ << " cube " << cube;
        }
      }
    }
  }

  const SurfaceMesh& mesh_;
  CutGrid grid_;
  std::string name_;
  Found& found_;
  RefinedRegion region_;
  std::set<Cell> doubtful_;
};

/// Compares all bodies of a mesh.
void compare(const test::NamedMesh& named, const Vec3d& origin, double spacing, Found& found) {
  const Solid solid = Solid::of(named.mesh);
  ASSERT_EQ(solid.rule(), SolidRule::polyhedron) << named.name;
  for (const SolidBody& body : solid.bodies()) {
    const SurfaceMesh mesh(body.mesh, {});
    const std::string name = named.name + " at " + std::to_string(spacing) + " from " + std::to_string(origin.x);
    Comparison(mesh, test::planes_around(body.mesh, origin, spacing, 2), name, found).run();
  }
}

TEST(CutGrid, EqualsBruteForceInThinSolids) {
  Found found;
  for (const test::NamedMesh& named : test::thin_solids()) {
    const Box3 box = bounds(named.mesh);
    const double side = std::max({box.size().x, box.size().y, box.size().z});
    for (const int cells : {1, 3, 6}) {
      ASSERT_NO_FATAL_FAILURE(compare(named, box.lower + Vec3d{0.1, 0.2, 0.3} * side, side / cells, found));
    }
  }
  EXPECT_GT(found.cut_cubes, 3000U);
  EXPECT_GT(found.failing, 30U);
  EXPECT_GT(found.several, 100U);
  EXPECT_GT(found.crossings, 3000U);
}

TEST(CutGrid, EqualsBruteForceIfPlanesPassThroughVertices) {
  Found found;
  for (const test::NamedMesh& named : test::whole_solids()) {
    const Box3 box = bounds(named.mesh);
    const double side = std::max({box.size().x, box.size().y, box.size().z});
    for (const double spacing : {1.0, 1.5, 2.0, 5.0}) {
      if (side / spacing > 6) continue;
      ASSERT_NO_FATAL_FAILURE(compare(named, {0, 0, 0}, spacing, found));
    }
  }
  EXPECT_GT(found.cut_cubes, 3000U);
  EXPECT_GT(found.failing, 10U);
  EXPECT_GT(found.several, 50U);
  EXPECT_GT(found.crossings, 3000U);
}

TriangleMesh random_tetrahedron(Random& random, bool is_whole) {
  TriangleMesh mesh;
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  for (int v = 0; v < 4; ++v) mesh.vertices.push_back(random.in_ball());
  if (is_whole) mesh = test::rounded(mesh, 2);
  const auto& p = mesh.vertices;
  if (orient3d(p[0], p[1], p[2], p[3]) < 0) mesh.triangles = reversed_triangles(mesh.triangles);
  return mesh;
}

bool is_flat(const TriangleMesh& tetrahedron) {
  const auto& p = tetrahedron.vertices;
  return orient3d(p[0], p[1], p[2], p[3]) == 0;
}

TEST(CutGrid, CellsOfAConvexSolidPassWithOneComponent) {
  Random random(29);
  for (int k = 0; k < 3000; ++k) {
    const TriangleMesh mesh = random_tetrahedron(random, k % 4 != 0);
    if (is_flat(mesh)) continue;
    const SurfaceMesh surface(mesh, {});
    const CutGrid grid(surface, test::planes_around(mesh, {0, 0, 0}, k % 3 == 0 ? 2 : 1), {});
    ASSERT_TRUE(grid.failing_cubes().empty()) << k;
    for (const Cell cell : grid.cut_cells()) ASSERT_LE(grid.components(cell), 1U) << k;
  }
}

/// A single plane cuts the void. The two cubes at the square with the hole fail.
TEST(CutGrid, CubesAtAHoleInASquareFail) {
  Random random(31);
  int holes = 0;
  for (int k = 0; k < 3000; ++k) {
    TriangleMesh mesh = random_tetrahedron(random, k % 4 != 0);
    if (is_flat(mesh)) continue;
    const std::size_t across = static_cast<std::size_t>(k) % 3;
    std::size_t above = 0;
    for (const Vec3d& p : mesh.vertices) above += is_above(p[across], 0) ? 1U : 0U;
    if (above == 0 || above == 4) continue;
    mesh.triangles = reversed_triangles(mesh.triangles);
    append(mesh, make_box({.size = {12, 12, 12}}));
    // Squares have side 6. Their planes lie around the void, except for one through its middle.
    Vec3d origin{-2.5, -2.25, -2.125};
    origin[across] = 0;
    const SurfaceMesh surface(mesh, {});
    const CutGrid grid(surface, test::planes_around(mesh, origin, 6, 1), {});
    ASSERT_EQ(grid.failing_cubes().size(), 2U) << k;
    ++holes;
  }
  EXPECT_GT(holes, 500);
}

}  // namespace
}  // namespace blum::detail
