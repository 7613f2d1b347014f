// Proves the fitting steps for curves. The centre of a round wall is found, and flat walls have none. Curves beside
// each other merge and keep their homotopy type. Bent curves get vertices. Cells that lie on other cells are removed,
// and only these. Vertices do not move through walls.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "blum/certificate/certificate.hpp"
#include "blum/complex/incidence.hpp"
#include "blum/core/random.hpp"
#include "blum/shapes/generators.hpp"
#include "medial_axis/fit/split_curves.hpp"
#include "medial_axis/fit/trim.hpp"
#include "medial_axis/fit/vertex_mover.hpp"
#include "medial_axis/surface/mesh_surface.hpp"
#include "support/exact_axes.hpp"

namespace blum {
namespace {

using detail::AxisLists;
using detail::AxisVertex;
using detail::merge_curves;
using detail::MeshSurface;
using detail::round_centre;
using detail::RoundCentre;
using detail::RoundLimits;
using detail::split_curves;
using detail::trim;
using detail::TrimLimits;
using detail::vertex_of_one_wall;
using detail::VertexMover;

struct Sample {
  explicit Sample(TriangleMesh given) : mesh(std::move(given)), sites(mesh), surface(mesh, sites, true, {}) {}

  [[nodiscard]] AxisVertex vertex(const Vec3d& at) const { return vertex_of_one_wall(at, surface.nearest(at, {})); }
  [[nodiscard]] AxisLists lists(const std::vector<Vec3d>& places) const {
    AxisLists lists;
    for (const Vec3d& at : places) lists.vertices.push_back(vertex(at));
    return lists;
  }

  TriangleMesh mesh;
  SiteTable sites;
  MeshSurface surface;
};

/// Two bars along x that meet at one end, with a gap of 0.02 between them.
TriangleMesh make_fork() {
  const std::vector<Point2> outline{{-2, -1}, {2, -1}, {2, -0.01}, {-1, -0.01}, {-1, 0.01}, {2, 0.01}, {2, 1}, {-2, 1}};
  return make_extrusion(outline, {}, {.thickness = 1});
}

ComplexView view_of(const AxisLists& lists) {
  return {lists.vertices.size(), lists.edges, lists.triangles};
}
BettiNumbers betti_of(const AxisLists& lists) {
  return homology(view_of(lists));
}
Incidence incidence_of(const AxisLists& lists) {
  return Incidence(view_of(lists));
}

std::vector<std::uint32_t> degrees(const AxisLists& lists) {
  std::vector<std::uint32_t> degree(lists.vertices.size(), 0);
  for (const auto& [a, b] : lists.edges) {
    ++degree[a];
    ++degree[b];
  }
  return degree;
}

// ---- Centres of round walls ----

constexpr double voxel = 0.05;
constexpr RoundLimits limits{voxel, 4 * voxel, 60};

TEST(RoundCentre, IsOnTheAxisOfATube) {
  const Sample tube(make_cylinder({.radius = 0.5, .height = 6, .sides = 400}));
  Random random(3);
  for (int n = 0; n < 50; ++n) {
    const double turn = 2 * std::numbers::pi * random.uniform();
    const double off = 3 * voxel * random.uniform();
    const Vec3d start{off * std::cos(turn), off * std::sin(turn), random.uniform()};
    const auto centre = round_centre(tube.surface, start, limits);
    ASSERT_TRUE(centre) << n;
    EXPECT_LE(std::hypot(centre->position.x, centre->position.y), 0.01 * voxel);
    EXPECT_NEAR(centre->position.z, start.z, 0.1 * voxel);
    EXPECT_GE(centre->feet.size(), 5U);
  }
}

TEST(RoundCentre, IsOnTheAxisOfAWideCone) {
  const Sample wide(test::revolved({{0, 0}, {1, 0}, {0, 1.2}}, 400));
  const auto on_axis = round_centre(wide.surface, {0.06, 0.04, 0.8}, limits);
  ASSERT_TRUE(on_axis);
  EXPECT_LE(std::hypot(on_axis->position.x, on_axis->position.y), 0.02 * voxel);
}

TEST(RoundCentre, DoesNotExistBetweenFlatWallsAndAtCorners) {
  const Sample box(make_box({.size = {4, 2, 1}}));
  for (const Vec3d& at : {Vec3d{0, 0, 0}, Vec3d{0, 0, 0.1}, Vec3d{1.7, 0, 0}, Vec3d{1.8, 0.8, 0.3}, Vec3d{1, 0.6, 0}}) {
    EXPECT_FALSE(round_centre(box.surface, at, limits)) << at.x << ' ' << at.y << ' ' << at.z;
  }
}

TEST(RoundCentre, StaysWithinTheAllowedDistance) {
  const Sample tube(make_cylinder({.radius = 0.5, .height = 6, .sides = 400}));
  EXPECT_FALSE(round_centre(tube.surface, {0.12, 0, 0}, {voxel, 2 * voxel, 60}));
  EXPECT_TRUE(round_centre(tube.surface, {0.12, 0, 0}, limits));
}

// ---- Curves beside each other ----

TEST(MergeCurves, CombOfEdgesOnOneLineBecomesAChain) {
  const Sample block(make_box({.size = {10, 2, 2}}));
  std::vector<Vec3d> places;
  for (int k = 0; k < 9; ++k) places.push_back({k - 4.0, 0.001 * (k % 3), 0});
  AxisLists lists = block.lists(places);
  for (std::uint32_t k = 1; k < places.size(); ++k) lists.add_edge({0, k}, static_cast<float>(k));
  merge_curves(lists, block.surface, 0.01, {});
  EXPECT_EQ(lists.edges.size(), 8U);
  EXPECT_EQ(betti_of(lists), (BettiNumbers{1, 0, 0}));
  const std::vector<std::uint32_t> degree = degrees(lists);
  EXPECT_EQ(degree, (std::vector<std::uint32_t>{1, 2, 2, 2, 2, 2, 2, 2, 1}));
}

TEST(MergeCurves, TreesOnARingBecomeARing) {
  const Sample torus(make_torus({.ring_radius = 1, .tube_radius = 0.3, .ring_segments = 200, .tube_segments = 60}));
  constexpr std::uint32_t count = 60;
  std::vector<Vec3d> places;
  for (std::uint32_t k = 0; k < count; ++k) {
    const double turn = 2 * std::numbers::pi * k / count;
    places.push_back({std::cos(turn), std::sin(turn), 0});
  }
  AxisLists lists = torus.lists(places);
  // Each edge leads two steps ahead around the ring, and each spur leads one step ahead.
  for (std::uint32_t k = 0; k < count; k += 2) lists.add_edge({k, (k + 2) % count}, 90);
  for (std::uint32_t k = 0; k < count; k += 2) lists.add_edge({k, k + 1}, 90);
  merge_curves(lists, torus.surface, 0.01, {});
  EXPECT_EQ(betti_of(lists), (BettiNumbers{1, 1, 0}));
  EXPECT_EQ(lists.edges.size(), count);
  for (const std::uint32_t degree : degrees(lists)) EXPECT_EQ(degree, 2U);
}

TEST(MergeCurves, DivergingAndDistantCurvesStay) {
  const Sample block(make_box({.size = {10, 4, 2}}));
  const std::vector<Vec3d> places{{-4, 0, 0}, {0, 0, 0}, {2, 0.2, 0}, {-3, 0.5, 0}};
  AxisLists lists = block.lists(places);
  for (std::uint32_t k = 1; k < places.size(); ++k) lists.add_edge({0, k}, 90);
  merge_curves(lists, block.surface, 0.05, {});
  EXPECT_EQ(lists.edges, (std::vector<std::array<std::uint32_t, 2>>{{0, 1}, {0, 2}, {0, 3}}));
}

TEST(MergeCurves, SidesOfTrianglesAndJoinedEndsStay) {
  const Sample block(make_box({.size = {10, 4, 2}}));
  AxisLists lists = block.lists({{-4, 0, 0}, {-3, 0, 0}, {-2, 0, 0}});
  // The loop of three edges is homotopy's: the third one joins the ends.
  lists.add_edge({0, 1}, 90);
  lists.add_edge({0, 2}, 90);
  lists.add_edge({1, 2}, 90);
  merge_curves(lists, block.surface, 0.05, {});
  EXPECT_EQ(betti_of(lists), (BettiNumbers{1, 1, 0}));
}

TEST(MergeCurves, CurvesOnBothSidesOfAWallStay) {
  const Sample fork(make_fork());
  AxisLists lists = fork.lists({{-1.5, 0, 0}, {1, -0.03, 0}, {1.5, 0.03, 0}});
  lists.add_edge({0, 1}, 90);
  lists.add_edge({0, 2}, 90);
  merge_curves(lists, fork.surface, 0.2, {});
  EXPECT_EQ(lists.edges[1], (std::array<std::uint32_t, 2>{0, 2}));
}

// ---- Curves that bend ----

TEST(SplitCurves, ChordsOfARingFollowItAndSidesOfTrianglesStay) {
  const Sample torus(make_torus({.ring_radius = 1, .tube_radius = 0.3, .ring_segments = 400, .tube_segments = 100}));
  AxisLists lists = torus.lists({{1, 0, 0}, {std::cos(1.0), std::sin(1.0), 0}, {0.9, 0.1, 0.05}});
  lists.add_edge({0, 1}, 90);
  lists.add_triangle({0, 1, 2}, 90);
  const auto middle = [&](const Vec3d& at) -> std::optional<AxisVertex> {
    const double size = std::hypot(at.x, at.y);
    return torus.vertex({at.x / size, at.y / size, 0});
  };
  AxisLists as_side = lists;
  EXPECT_FALSE(split_curves(as_side, incidence_of(as_side), torus.surface, voxel, middle, {}));
  EXPECT_EQ(as_side.vertices.size(), 3U) << "the edge is a side";
  lists.triangles.clear();
  lists.triangle_angles.clear();
  EXPECT_TRUE(split_curves(lists, incidence_of(lists), torus.surface, voxel, middle, {}));
  EXPECT_EQ(lists.edges.size() + 2, lists.vertices.size());
  for (const auto& [a, b] : lists.edges) {
    const Vec3d half = 0.5 * (lists.vertices[a].position + lists.vertices[b].position);
    EXPECT_LE(1 - std::hypot(half.x, half.y), 0.02 * voxel);
  }
}

// ---- Cells that lie on other cells ----

constexpr TrimLimits trim_limits{30, 0.01, 0.1, 0.5, 0.02};

AxisLists square_with(const std::vector<Vec3d>& more) {
  AxisLists lists;
  const auto add = [&](const Vec3d& at) { lists.vertices.push_back({at, 1, {at, at}, {}, 90}); };
  for (const Vec3d& at : {Vec3d{0, 0, 0}, Vec3d{2, 0, 0}, Vec3d{2, 2, 0}, Vec3d{0, 2, 0}}) add(at);
  for (const Vec3d& at : more) add(at);
  lists.add_triangle({0, 1, 2}, 90);
  lists.add_triangle({0, 2, 3}, 90);
  return lists;
}
bool trim_all_seen(AxisLists& lists) {
  std::vector<double> angles;
  for (const AxisVertex& vertex : lists.vertices) angles.push_back(vertex.separation_angle);
  return trim(lists, incidence_of(lists), angles, trim_limits, {});
}

TEST(Trim, FlatTrianglesWhoseLongestSideIsNotFreeStay) {
  AxisLists flat = square_with({{1, -0.009, 0}});
  flat.add_triangle({0, 1, 4}, 90);
  EXPECT_FALSE(trim_all_seen(flat));
  EXPECT_EQ(flat.triangles.size(), 3U);
}

TEST(Trim, ARibbonWithoutWidthBecomesACurve) {
  AxisLists ribbon;
  for (const double x : {0.0, 1.0, 2.0, 3.0}) ribbon.vertices.push_back({{x, 0.002 * x * x, 0}, 1, {}, {}, 90});
  ribbon.add_triangle({0, 1, 2}, 90);
  ribbon.add_triangle({1, 2, 3}, 90);
  trim_all_seen(ribbon);
  EXPECT_TRUE(ribbon.triangles.empty());
  EXPECT_EQ(ribbon.edges.size(), 3U);
  EXPECT_EQ(betti_of(ribbon), (BettiNumbers{1, 0, 0}));
}

TEST(Trim, TriangleThatIsHighStays) {
  AxisLists ribbon;
  for (const double x : {0.0, 1.0, 2.0}) ribbon.vertices.push_back({{x, 0.05 * x * (2 - x), 0}, 1, {}, {}, 90});
  ribbon.add_triangle({0, 1, 2}, 90);
  AxisLists round = ribbon;
  trim_all_seen(ribbon);
  EXPECT_EQ(ribbon.triangles.size(), 1U);
  for (AxisVertex& vertex : round.vertices) vertex.separation_angle = 0;
  EXPECT_TRUE(trim(round, incidence_of(round), {90, 90, 90}, trim_limits, {}));
  EXPECT_TRUE(round.triangles.empty()) << "in the middle of what is round more is seen than by two footprints";
}

TEST(Trim, WhiskersGoAndLongCurvesStay) {
  AxisLists lists = square_with({{1, 1, 0.01}, {0, -0.4, 0}, {3, 3, 0}});
  lists.add_edge({0, 4}, 90);  // lies on the sheet
  lists.add_edge({1, 5}, 90);  // sticks out of the rim once its vertex is moved below
  lists.vertices[5].position = {2, -0.4, 0};
  lists.add_edge({2, 6}, 90);  // a curve
  trim_all_seen(lists);
  EXPECT_EQ(lists.triangles.size(), 2U);
  ASSERT_EQ(lists.edges.size(), 1U);
  EXPECT_EQ(lists.vertices.back().position, (Vec3d{3, 3, 0}));
}

// ---- Moving ----

TEST(VertexMover, MovesThroughWallsAreTakenBack) {
  const Sample fork(make_fork());
  AxisLists lists = fork.lists({{-1.5, 0, 0}, {1, -0.5, 0}, {1.5, -0.5, 0}});
  lists.add_edge({0, 1}, 90);
  lists.add_edge({1, 2}, 90);
  const Incidence incidence({lists.vertices.size(), lists.edges, lists.triangles});
  const Context context;
  VertexMover mover(lists, incidence, fork.surface, context);
  const std::vector<Vec3d> places{{-1.6, 0.1, 0}, {1, 0.5, 0}, {1.5, -0.4, 0}};
  const auto where = [&](std::uint32_t v) -> std::optional<AxisVertex> { return fork.vertex(places[v]); };
  // The edge between 1 and 2 would pass through the gap, so both stay. Vertex 0 moves with its edge.
  const double furthest = mover.make(mover.moves_to(where));
  EXPECT_EQ(lists.vertices[1].position, (Vec3d{1, -0.5, 0}));
  EXPECT_EQ(lists.vertices[2].position, (Vec3d{1.5, -0.5, 0}));
  EXPECT_LE(furthest, 0.15);
  const auto only_last = [&](std::uint32_t v) -> std::optional<AxisVertex> {
    return v == 2 ? std::optional(fork.vertex(places[v])) : std::nullopt;
  };
  EXPECT_NEAR(mover.make(mover.moves_to(only_last)), 0.1, 1e-12);
  EXPECT_EQ(lists.vertices[2].position, places[2]);
}

}  // namespace
}  // namespace blum
