// Proves that axes of round rods, nails, bent wires and springs are the middle of the rod, from end to end, with its
// radius. Their diameters are 4 voxels to an eighth of a voxel, and they lie along the grid and across it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "blum/certified/certified_axis.hpp"
#include "blum/core/random.hpp"
#include "blum/shapes/generators.hpp"
#include "support/amount.hpp"
#include "support/medial_check.hpp"
#include "support/sweep.hpp"

namespace blum {
namespace {

using test::Path;

constexpr double radius = 0.5;
/// Radii: an edge of the axis may cut off this much of a bend, and a vertex may be this far from the middle.
constexpr double off_the_middle = 0.15;
/// Radii: the part of the path at each end that the axis need not reach. The last ball touches the flat end.
constexpr double at_an_end = 1.5;

/// One or more rods, and their middles.
struct Rods {
  TriangleMesh mesh;
  std::vector<Path> paths;
  double least_radius = radius;  ///< of the inscribed circles of all cross sections

  void add(const Path& path, std::uint32_t sides) {
    append(mesh, test::rod_along(path, radius, sides));
    paths.push_back(path);
    least_radius = std::min(least_radius, radius * std::cos(std::numbers::pi / sides));
  }
  void turn(const Mat3& rotation, const Vec3d& offset) {
    for (Vec3d& v : mesh.vertices) v = rotation * v + offset;
    for (Path& path : paths) {
      for (Vec3d& v : path) v = rotation * v + offset;
    }
  }
};

/// Rotations: along the grid, along diagonals, and random ones. Half of them, unless all cases are tested.
/// @param shift  chooses the half.
std::vector<Mat3> directions(Random& random, std::size_t shift) {
  std::vector<Mat3> out{test::rotation({0, 0, 1}, 0), test::rotation({0, 1, 0}, 90), test::rotation({1, 0, 0}, 45),
                        test::rotation({1, -1, 0}, std::acos(std::numbers::inv_sqrt3) * 180 / std::numbers::pi)};
  for (int n = 0; n < 2; ++n) out.push_back(test::rotation(random.in_ball(), 360 * random.uniform()));
  return test::some(out, 3, shift);
}

std::string direction_text(const Mat3& turn) {
  std::ostringstream text;
  text << "z axis to " << turn.columns[2].x << " " << turn.columns[2].y << " " << turn.columns[2].z;
  return text.str();
}

void expect_middle(const Rods& rods, double theta) {
  const CertifiedAxes axes = certified_axes(rods.mesh, {.thetas = {theta}});
  ASSERT_TRUE(axes.holds()) << axes.mismatches.front();
  const Complex& axis = axes.axes.front().axis.axis;
  const MedialView view(axis);
  TriangleMesh middles;
  std::vector<Vec3d> to_reach;
  for (const Path& path : rods.paths) {
    append(middles, test::as_segments(path));
    for (const Vec3d& p : test::points_along(path, radius, at_an_end * radius)) to_reach.push_back(p);
  }
  // The middles of edges: axes of bent rods cut corners there.
  std::vector<Vec3d> points = axis.positions;
  for (const auto& [a, b] : axis.edges) points.push_back(0.5 * (axis.positions[a] + axis.positions[b]));
  EXPECT_LE(test::furthest_from(middles, points), off_the_middle * radius);
  EXPECT_LE(test::furthest_from(test::shape_of(axis), to_reach), 2 * off_the_middle * radius)
      << "part of the rod is missing";
  for (std::size_t v = 0; v < axis.positions.size(); ++v) {
    EXPECT_GE(view.radius[v], (1 - off_the_middle) * rods.least_radius);
  }
}

TEST(SlowMedialThinRods, StraightOnesHaveAnAxisFromEndToEnd) {
  Random random(46);
  std::size_t shift = 0;
  for (const double length : {30, 150, 200, 300, 2000}) {
    for (const Mat3& turn : directions(random, shift++)) {
      for (const std::uint32_t sides : {5U, 48U}) {
        for (const double theta : {120.0, 170.0}) {
          if (sides == 5 && theta > 144) continue;  // the largest separation angle in a pentagon is 144 degrees
          SCOPED_TRACE(testing::Message() << "length " << length << ", " << sides << " sides, theta " << theta << ", "
                                          << direction_text(turn));
          Rods rods;
          rods.add({{0, 0, 0}, {0, 0, length}}, sides);
          rods.turn(turn, random.in_ball());
          expect_middle(rods, theta);
        }
      }
    }
  }
}

TEST(SlowMedialThinRods, TwoParallelOnesHaveTwoAxes) {
  Random random(47);
  std::size_t shift = 0;
  for (const double length : {50, 150, 200, 400}) {
    for (const Mat3& turn : directions(random, shift++)) {
      SCOPED_TRACE(testing::Message() << "length " << length << ", " << direction_text(turn));
      Rods rods;
      rods.add({{0, 0, 0}, {0, 0, length}}, 24);
      rods.add({{1.5, 0, 0}, {1.5, 0, length}}, 24);
      rods.turn(turn, random.in_ball());
      expect_middle(rods, 120);
    }
  }
}

TEST(SlowMedialThinRods, BentOnesKeepTheirBend) {
  Random random(48);
  std::size_t shift = 0;
  for (const auto& [length, bend] : {std::pair{20.0, 1.0}, {60.0, 2.0}, {100.0, 3.0}, {200.0, 3.0}}) {
    for (const Mat3& turn : directions(random, shift++)) {
      for (const std::uint32_t sides : {16U, 48U}) {
        SCOPED_TRACE(testing::Message() << "length " << length << ", " << sides << " sides, " << direction_text(turn));
        Rods rods;
        rods.add(test::l_shape(length, bend), sides);
        rods.turn(turn, {});
        expect_middle(rods, 120);
      }
    }
  }
}

TEST(SlowMedialThinRods, SpringsAreOneCurve) {
  Random random(49);
  struct Spring {
    double radius, pitch;
    int turns;
  };
  std::size_t shift = 0;
  for (const Spring& spring : {Spring{3, 1.6, 1}, Spring{10, 3, 2}, Spring{100, 15, 3}}) {
    for (const Mat3& turn : directions(random, shift++)) {
      SCOPED_TRACE(testing::Message() << "radius " << spring.radius << ", " << direction_text(turn));
      Rods rods;
      rods.add(test::helix(spring.radius, spring.pitch, spring.turns), 16);
      rods.turn(turn, {});
      expect_middle(rods, 120);
    }
  }
}

/// The axis of a nail contains the middle of its shank as a curve. Its head has a sheet.
TEST(SlowMedialThinRods, NailsHaveTheirWholeShank) {
  Random random(50);
  std::size_t shift = 0;
  for (const double length : {30, 100, 200, 300}) {
    for (const Mat3& turn : directions(random, shift++)) {
      SCOPED_TRACE(testing::Message() << "length " << length << ", " << direction_text(turn));
      const Path shank{{0, 0, 0}, {0, 0, length}};
      Rods nail;
      nail.mesh = test::rod_along({{0, 0, 0}, {0, 0, length}, {0, 0, length + 1e-9}, {0, 0, length + 2}},
                                  {radius, radius, 6 * radius, 6 * radius}, 24);
      nail.paths.push_back(shank);
      nail.turn(turn, random.in_ball());
      const CertifiedAxes axes = certified_axes(nail.mesh, {.thetas = {120}});
      ASSERT_TRUE(axes.holds()) << axes.mismatches.front();
      const std::vector<Vec3d> to_reach = test::points_along(nail.paths[0], radius, 2 * radius);
      EXPECT_LE(test::furthest_from(test::shape_of(axes.axes.front().axis.axis), to_reach), off_the_middle * radius);
    }
  }
}

}  // namespace
}  // namespace blum
