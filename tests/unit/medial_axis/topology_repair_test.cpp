// Proves that voxels are chosen with the topology of the solid where taking those whose centre is inside does not give
// it, no further from the surface than told, and that the report counts what was done.
#include "medial_axis/topology_repair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stop_token>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/grid/voxel_topology.hpp"
#include "blum/shapes/generators.hpp"
#include "medial_axis/voxelize.hpp"
#include "support/voxel_sets.hpp"

namespace blum {
namespace {

using Place = std::array<std::int64_t, 3>;

/// A solid by its depth at the centres of a cube of voxels of side 1, from the middle of the cube.
struct Solid {
  Solid(std::int64_t side, const std::function<double(const Vec3d&)>& depth_at) : size{side, side, side} {
    const double middle = 0.5 * static_cast<double>(side - 1);
    test::for_each_voxel(size, 0, [&](auto i, auto j, auto k) {
      const Vec3d at{static_cast<double>(i) - middle, static_cast<double>(j) - middle, static_cast<double>(k) - middle};
      depth.push_back(static_cast<float>(depth_at(at)));
    });
  }
  [[nodiscard]] float depth_of(const Place& at) const {
    return depth[static_cast<std::size_t>((at[2] * size[1] + at[1]) * size[0] + at[0])];
  }
  [[nodiscard]] VoxelSet inside() const {
    return test::voxels_where(size, [&](auto i, auto j, auto k) { return depth_of({i, j, k}) > 0; });
  }

  Place size;
  std::vector<float> depth;
};

double in_ball(const Vec3d& at, double radius) {
  return radius - length(at);
}
double in_torus(const Vec3d& at, double ring, double tube) {
  return tube - std::hypot(std::hypot(at.x, at.y) - ring, at.z);
}

struct Choice {
  VoxelSet voxels;
  RepairReport report;
};

Choice choose(const Solid& solid, const BettiNumbers& wanted) {
  Choice choice;
  choice.voxels = VoxelSet(solid.size);
  choice.report = choose_voxels(solid.depth, wanted, std::sqrt(3.0), choice.voxels, {});
  return choice;
}

/// Counts again what a report says.
void expect_true_report(const Solid& solid, const Choice& choice, const BettiNumbers& wanted) {
  RepairReport expected;
  test::for_each_voxel(solid.size, 0, [&](auto i, auto j, auto k) {
    const double depth = solid.depth_of({i, j, k});
    const bool is_in = choice.voxels.contains(i, j, k);
    if (is_in == (depth > 0)) return;
    ++(is_in ? expected.added : expected.removed);
    expected.deviation = std::max(expected.deviation, std::abs(depth));
  });
  EXPECT_EQ(choice.report.added, expected.added);
  EXPECT_EQ(choice.report.removed, expected.removed);
  EXPECT_EQ(choice.report.deviation, expected.deviation);
  EXPECT_EQ(choice.report.betti, betti_numbers(choice.voxels));
  EXPECT_EQ(choice.report.is_right, choice.report.betti == wanted);
}

void expect_repaired(const Solid& solid, const BettiNumbers& wanted, double deviation) {
  EXPECT_NE(betti_numbers(solid.inside()), wanted) << "there is nothing to repair";
  const Choice choice = choose(solid, wanted);
  expect_true_report(solid, choice, wanted);
  EXPECT_TRUE(choice.report.is_right);
  EXPECT_GT(choice.report.added + choice.report.removed, 0U);
  EXPECT_LE(choice.report.deviation, deviation);
}

TEST(TopologyRepair, WhatIsRightStaysAsItIs) {
  for (const auto& [solid, wanted] :
       {std::pair{Solid(20, [](const Vec3d& at) { return in_ball(at, 7.3); }), BettiNumbers{1, 0, 0}},
        std::pair{Solid(30, [](const Vec3d& at) { return in_torus(at, 9, 3.2); }), BettiNumbers{1, 1, 0}}}) {
    const Choice choice = choose(solid, wanted);
    EXPECT_EQ(choice.voxels, solid.inside());
    EXPECT_EQ(choice.report.added + choice.report.removed, 0U);
    EXPECT_EQ(choice.report.deviation, 0);
    expect_true_report(solid, choice, wanted);
  }
}

/// A ring that is cut by a slot too narrow for a voxel.
TEST(TopologyRepair, EndsThatNearlyTouchAreHeldApart) {
  const Solid solid(30, [](const Vec3d& at) {
    const double out_of_slot = at.y > 0 ? std::abs(at.x) - 0.1 : length(Vec3d{at.x, at.y, 0});
    return std::min(in_torus(at, 9, 3.2), out_of_slot);
  });
  expect_repaired(solid, {1, 0, 0}, 1);
}

/// A wall between a void and the outside that is thinner than a voxel.
TEST(TopologyRepair, ThinWallsAreClosed) {
  const Solid solid(30,
                    [](const Vec3d& at) { return std::min(in_ball(at, 10), length(at - Vec3d{0.1, 0.2, 3.3}) - 6.5); });
  expect_repaired(solid, {1, 0, 1}, std::sqrt(3.0));
}

/// A handle thinner than a voxel.
TEST(TopologyRepair, ThinHandlesAreKept) {
  const Solid solid(
      40, [](const Vec3d& at) { return std::max(in_ball(at, 8), in_torus(at - Vec3d{9.3, 0.2, 0.4}, 7, 0.45)); });
  expect_repaired(solid, {1, 1, 0}, std::sqrt(3.0));
}

/// Two balls with a neck between them that is thinner than a voxel.
TEST(TopologyRepair, ThinNecksAreKept) {
  const Solid solid(40, [](const Vec3d& at) {
    const double in_neck = std::min(0.3 - std::hypot(at.y - 0.1, at.z + 0.2), 9 - std::abs(at.x));
    return std::max({in_ball(at - Vec3d{9, 0, 0}, 6), in_ball(at + Vec3d{9, 0, 0}, 4), in_neck});
  });
  expect_repaired(solid, {1, 0, 0}, std::sqrt(3.0));
}

TEST(TopologyRepair, WhatIsOutOfReachIsSaidToBeWrong) {
  const Solid ball(16, [](const Vec3d& at) { return in_ball(at, 5); });
  for (const BettiNumbers& wanted : {BettiNumbers{1, 40, 0}, BettiNumbers{1, 0, 30}}) {
    const Choice choice = choose(ball, wanted);
    EXPECT_FALSE(choice.report.is_right);
    expect_true_report(ball, choice, wanted);
  }
}

TEST(TopologyRepair, TheOutermostLayerStaysFree) {
  const Solid solid(12, [](const Vec3d&) { return 1; });
  const Choice choice = choose(solid, {1, 0, 0});
  EXPECT_EQ(choice.voxels.count(), 1000U);
  test::for_each_voxel(solid.size, 0, [&](auto i, auto j, auto k) {
    const bool is_outermost = std::min({i, j, k}) == 0 || std::max({i, j, k}) == 11;
    ASSERT_EQ(choice.voxels.contains(i, j, k), !is_outermost);
  });
}

/// Thin wedges that lie across the grid gain handles along their edge at any size of voxels.
TEST(TopologyRepair, WedgesHaveNoHandlesAtAnySize) {
  int wrong = 0;
  for (const double angle : {3.0, 10.0, 25.0}) {
    TriangleMesh wedge = make_wedge({.angle = angle});
    for (Vec3d& v : wedge.vertices) v = test::turned_grid({}).direction * v;
    const blum::Solid solid = blum::Solid::of(wedge);
    for (const int resolution : {8, 16, 32, 64, 100}) {
      const Voxelized out = voxelize_body(solid.bodies().front(), 1.0 / resolution, {});
      EXPECT_EQ(betti_numbers(out.solid.voxels), (BettiNumbers{1, 0, 0})) << angle << " degrees, " << resolution;
      EXPECT_TRUE(out.report.topology_matches);
      EXPECT_LE(out.report.deviation, std::sqrt(3.0) / resolution);
      const VoxelSet inside = test::voxels_where(out.solid.grid.size, [&](auto i, auto j, auto k) {
        return out.solid.depth[out.solid.grid.index(i, j, k)] > 0;
      });
      wrong += betti_numbers(inside) != BettiNumbers{1, 0, 0} ? 1 : 0;
    }
  }
  EXPECT_GT(wrong, 5) << "wedges should need the repair";
}

TEST(TopologyRepair, CancelStopsIt) {
  const Solid solid(20, [](const Vec3d& at) { return in_ball(at, 7); });
  std::stop_source source;
  source.request_stop();
  VoxelSet voxels(solid.size);
  EXPECT_THROW((void)choose_voxels(solid.depth, {1, 1, 0}, 1, voxels, {.cancel = source.get_token()}), Cancelled);
}

}  // namespace
}  // namespace blum
