// Proves that searches and exact signs of planes agree with slow ones: all planes one after the other, and numbers of
// many digits. Vertices of large and of degenerate solids lie inside all planes, and each of their planes touches them.
#include "voronoi/planes/plane_regions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"
#include "support/double_cone.hpp"
#include "voronoi/planes/plane_tree.hpp"

namespace blum::voronoi {
namespace {

using Float = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>>;
using Index = HalfSpaces::Index;

ConvexFaces faces_of(const TriangleMesh& mesh) {
  const SiteTable table(mesh);
  const PolyhedronSites sites = polyhedron_sites(mesh, table);
  std::vector<std::uint32_t> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0U);
  std::optional<ConvexFaces> faces = convex_faces(mesh, table, sites, all, 0, {});
  EXPECT_TRUE(faces);
  return std::move(*faces);
}

struct Named {
  std::string name;
  ConvexFaces faces;
};

std::vector<Named> solids() {
  std::vector<Named> out;
  out.push_back({"Box", faces_of(make_box())});
  out.push_back({"Cylinder", faces_of(make_cylinder({.sides = 64}))});
  out.push_back({"Sphere", faces_of(make_sphere({.frequency = 6}))});
  out.push_back({"DoubleCone", faces_of(test::double_cone(150))});
  return out;
}

std::vector<PlaneCorner> corners_of(const ConvexFaces& faces) {
  bool is_bounded = false;
  std::vector<PlaneCorner> out = plane_corners(faces.spaces, faces, is_bounded, {});
  EXPECT_TRUE(is_bounded);
  return out;
}

double depth_of(const HalfSpaces& spaces, const PlacedCorner& point, Index plane) {
  return dot(spaces.normal(plane), point.at) + spaces.offset(plane) - point.height;
}

TEST(PlaneTree, FindsThePlanesOfASlowSearch) {
  for (const Named& solid : solids()) {
    SCOPED_TRACE(solid.name);
    const HalfSpaces& spaces = solid.faces.spaces;
    const PlaneTree tree(spaces, solid.faces.middle);
    Random random(3);
    std::size_t outside = 0;
    for (int k = 0; k < 2000; ++k) {
      PlacedCorner point;
      point.at = (random.in_cube() * 2.0 - Vec3d{1, 1, 1}) - solid.faces.origin;
      point.error = k % 3 == 0 ? 0.1 : 0;
      double least = HUGE_VAL;
      for (Index plane = 0; plane < spaces.plane_count(); ++plane) {
        least = std::min(least, depth_of(spaces, point, plane));
      }
      // Points on the graph of the distance, above and below it.
      point.height = least + (k % 2 == 0 ? 0 : random.uniform(-0.1, 0.1));
      PlaneTree::Found found;
      tree.find(point, found);
      std::sort(found.planes.begin(), found.planes.end());
      const double error = 3 * point.error + 1e-14;
      std::vector<Index> touched;
      for (Index plane = 0; plane < spaces.plane_count(); ++plane) {
        if (depth_of(spaces, point, plane) <= error) touched.push_back(plane);
      }
      const double lowest = least - point.height;
      ASSERT_EQ(found.is_outside, lowest < -error) << lowest;
      if (found.is_outside) {
        ++outside;
        ASSERT_EQ(found.planes.size(), 1U);
        ASSERT_NEAR(depth_of(spaces, point, found.planes[0]), lowest, 1e-14);
      } else {
        ASSERT_EQ(found.planes, touched);
      }
    }
    EXPECT_GT(outside, 100U);
  }
}

/// Returns the depth of a corner in a half-space, in numbers of 100 digits.
Float slow_depth(const ExactCorner& corner, const IntegerPlane& plane) {
  const auto value = [&](const auto& factor) {
    Float sum = 0;
    for (std::size_t k = 0; k < corner.count; ++k) {
      sum += Float(factor(corner.terms[k])) * sqrt(Float(corner.terms[k].root->square()));
    }
    return sum;
  };
  const Float all = value([](const ExactCorner::Term& term) { return term.all; });
  Float out = Float(plane.offset);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out += Float(plane.normal[axis]) * value([&](const ExactCorner::Term& term) { return term.at[axis]; }) / all;
  }
  const auto& [x, y, z] = plane.normal;
  return out - sqrt(Float(x * x + y * y + z * z)) * Float(corner.height) / all;
}

/// Planes in integers: random ones, and some that touch each other's points.
std::vector<IntegerPlane> random_planes(std::uint64_t seed, int range) {
  Random random(seed);
  std::vector<IntegerPlane> out;
  while (out.size() < 12) {
    const auto number = [&] { return static_cast<std::int64_t>(random.uniform(-range, range + 0.999)); };
    IntegerPlane plane{{number(), number(), number()}, number()};
    if (plane.normal[0].is_zero() && plane.normal[1].is_zero() && plane.normal[2].is_zero()) continue;
    out.push_back(std::move(plane));
  }
  return out;
}

TEST(HalfSpaces, PositionsAgreeWithManyDigits) {
  std::size_t touching = 0;
  std::size_t checked = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    // Small numbers make many points in which five planes meet.
    const std::vector<IntegerPlane> planes = random_planes(seed, seed % 2 == 0 ? 2 : 1000);
    const HalfSpaces spaces(planes, 1000, 1, {});
    Random random(seed);
    for (int k = 0; k < 40; ++k) {
      HalfSpaces::Base base{};
      for (Index& plane : base) plane = static_cast<Index>(random.uniform(0, 11.999));
      if (k % 4 == 0) base[3] = spaces.floor();
      ExactCorner corner = spaces.exact_corner(base);
      if (corner.sign == 0) continue;
      for (Index of = 0; of < planes.size(); ++of) {
        const Float depth = slow_depth(corner, planes[of]);
        const int expected = abs(depth) < Float(1e-60) ? 0 : depth.sign();
        const int exact = spaces.position(corner, of).side;
        ExactCorner placed = corner;
        spaces.place(placed);
        ASSERT_EQ(exact, expected);
        ASSERT_EQ(spaces.position(placed, of).side, expected);
        const double fast = spaces.depth(HalfSpaces::rounded(placed), of);
        ASSERT_TRUE(fast == 0 || (fast > 0) == (expected > 0));
        ++checked;
        touching += expected == 0 && std::find(base.begin(), base.end(), of) == base.end() ? 1 : 0;
      }
    }
  }
  EXPECT_GT(checked, 5000U);
  EXPECT_GT(touching, 50U);
}

/// Each vertex is inside all half-spaces, and its list contains exactly those that it touches.
TEST(PlaneRegions, VerticesListAllPlanesThatTheyTouch) {
  for (const Named& solid : solids()) {
    SCOPED_TRACE(solid.name);
    const HalfSpaces& spaces = solid.faces.spaces;
    const std::vector<PlaneCorner> corners = corners_of(solid.faces);
    const std::size_t step = 1 + corners.size() / 100;
    for (std::size_t k = 0; k < corners.size(); k += step) {
      ExactCorner corner = spaces.exact_corner(corners[k].base);
      spaces.place(corner);
      std::vector<Index> touched;
      for (Index of = 0; of <= spaces.floor(); ++of) {
        const int side = spaces.position(corner, of).side;
        ASSERT_GE(side, 0);
        if (side == 0) touched.push_back(of);
      }
      ASSERT_EQ(corners[k].planes, touched);
    }
  }
}

TEST(PlaneRegions, OfADoubleConeMeetAtBothEnds) {
  const ConvexFaces faces = faces_of(test::double_cone(150));
  std::size_t ends = 0;
  for (const PlaneCorner& corner : corners_of(faces)) ends += corner.planes.size() == 151 ? 1 : 0;
  EXPECT_EQ(ends, 2U);
}

}  // namespace
}  // namespace blum::voronoi
