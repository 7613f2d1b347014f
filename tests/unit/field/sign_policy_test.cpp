// Proves that the sign rule depends only on mesh and mode, for all grids and for queries, and names crossings. The
// sides of queries are right beside parts that cross. Winding numbers are computed only there.
#include "field/sign/policy.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "blum/core/error.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/field/field.hpp"
#include "blum/field/reference.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/shapes/generators.hpp"
#include "field/sign/sides.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

using sign::Method;
using sign::Plan;

Plan plan_of(const MeshView& mesh, SignMode mode = SignMode::automatic) {
  return sign::Planner().plan(mode, mesh, SiteTable(mesh), {});
}

TriangleMesh moved_by(TriangleMesh mesh, const Vec3d& offset) {
  for (Vec3d& p : mesh.vertices) p += offset;
  return mesh;
}

/// Returns one shell that faces outwards. A dent protrudes slightly through its opposite side, so a few triangles
/// cross. Only a node in the tip would reveal the crossing.
TriangleMesh barely_crossing() {
  TriangleMesh mesh = make_box({.segments = {8, 8, 8}});
  const double half = bounds(mesh).upper.z;
  for (Vec3d& p : mesh.vertices) {
    if (length(p - Vec3d{0, 0, half}) < 1e-9) p.z = -1.001 * half;
  }
  return mesh;
}

TEST(SignPolicy, TheReportedRuleDependsOnNoGrid) {
  const TriangleMesh mesh = barely_crossing();
  const Plan plan = plan_of(mesh);
  EXPECT_EQ(plan.rule, SignRule::winding);
  EXPECT_NE(plan.reason.find("crosses or touches itself"), std::string::npos) << plan.reason;
  Box3 tip = bounds(mesh);
  tip.lower = {-0.001, -0.001, 1.001 * tip.lower.z / 1.001};
  tip.upper = {0.001, 0.001, tip.lower.z + 0.002};
  for (const GridSpec& grid : {grid_around(bounds(mesh), 16), grid_around(bounds(mesh), 33), grid_in(tip, 9)}) {
    const Field field = distance_field(mesh, grid);
    EXPECT_EQ(field.sign_rule, plan.rule);
    EXPECT_EQ(field.sign_reason, plan.reason);
  }
  const ClosestPointQuery query(mesh);
  EXPECT_EQ(query.sign_rule(), plan.rule);
  EXPECT_EQ(query.sign_reason(), plan.reason);
}

TEST(SignPolicy, OfAFrameDependsOnItsMeshAlone) {
  const TriangleMesh simple = make_sphere({});
  TriangleMesh folded = simple;
  folded.vertices.front() = folded.vertices.front() * -1.5;  // through the opposite side
  const GridSpec grid = grid_around(bounds(simple), 12);
  FieldSolver solver(grid);
  for (const TriangleMesh* mesh : std::array<const TriangleMesh*, 5>{&simple, &folded, &simple, &simple, &folded}) {
    const Plan plan = plan_of(*mesh);
    EXPECT_EQ(plan.rule, mesh == &simple ? SignRule::normals : SignRule::winding) << plan.reason;
    const Field& field = solver.compute(*mesh);
    EXPECT_EQ(field.sign_rule, plan.rule);
    EXPECT_EQ(field.sign_reason, plan.reason);
  }
}

TEST(SignPolicy, GivesAReasonForEachRule) {
  const auto expect = [](const TriangleMesh& mesh, SignRule rule, Method method, const std::string& reason) {
    const Plan plan = plan_of(mesh);
    EXPECT_EQ(plan.rule, rule) << plan.reason;
    EXPECT_EQ(plan.method, method) << plan.reason;
    EXPECT_NE(plan.reason.find(reason), std::string::npos) << plan.reason;
  };
  TriangleMesh mesh = make_sphere({.frequency = 3});
  expect(mesh, SignRule::normals, Method::crossings, "faces outwards");
  TriangleMesh twice = mesh;
  append(twice, mesh, {3, 0, 0});
  expect(twice, SignRule::normals, Method::crossings, "faces outwards");
  reverse_triangles(mesh);
  expect(mesh, SignRule::normals, Method::crossings, "after 1 shell was reversed");
  mesh.triangles.pop_back();
  expect(mesh, SignRule::winding, Method::sums, "3 boundary edges");
  expect(make_points({}), SignRule::none, Method::none, "no triangles");
  TriangleMesh beside = test::box_between({0, 0, 0}, {1, 1, 1});
  append(beside, test::box_between({1, 0, 0}, {2, 1, 1}));
  expect(beside, SignRule::winding, Method::crossings, "touches itself");
  // Shells that cross have no depth. The reason must not depend on which shell the search for the depth finds.
  for (const Vec3d& by : {Vec3d{0.3, 0.2, 0.1}, Vec3d{0.9, 0.8, 0.7}}) {
    TriangleMesh across = test::box_between({0, 0, 0}, {1, 1, 1});
    append(across, test::box_between(by, by + Vec3d{1, 1, 1}));
    expect(across, SignRule::winding, Method::crossings, "crosses or touches itself");
  }
  TriangleMesh within = test::box_between({0, 0, 0}, {3, 3, 3});
  append(within, test::box_between({1, 1, 1}, {2, 2, 2}));
  expect(within, SignRule::winding, Method::crossings, "do not all face away");
}

TEST(SignPolicy, OfUnexaminedMeshes) {
  EXPECT_EQ(sign::plan_unseen_signs(SignMode::automatic, 1).rule, SignRule::winding);
  EXPECT_EQ(sign::plan_unseen_signs(SignMode::automatic, 0).rule, SignRule::none);
  EXPECT_EQ(sign::plan_unseen_signs(SignMode::none, 1).rule, SignRule::none);
  EXPECT_THROW((void)sign::plan_unseen_signs(SignMode::winding, 0), InvalidOption);
  EXPECT_THROW((void)sign::plan_unseen_signs(SignMode::normals, 1), InvalidOption);
}

/// Compares the sides of places with the full sum; returns the number of sites that need winding numbers.
std::size_t expect_true_sides(const TriangleMesh& mesh, SignMode mode, std::uint64_t seed) {
  const SiteTable sites(mesh);
  const Bvh bvh(mesh, sites);
  const Plan plan = sign::Planner().plan(mode, mesh, sites, {});
  const sign::Sides sides(plan, mesh, sites, bvh, {});
  const double extent = bounds(mesh).diagonal();
  std::size_t wrong = 0;
  for (const Vec3d& place : test::places_around(mesh, 500, seed)) {
    const NearestSite nearest = *bvh.nearest(place);
    if (nearest.distance < 1e-9 * extent) continue;
    const double w = reference::winding_number(mesh, place);
    if (plan.method == Method::sums && std::abs(w - 0.5) < 1e-9) continue;
    wrong += sides.is_inside(place, nearest) != (w > plan.level + 0.5) ? 1 : 0;
  }
  EXPECT_EQ(wrong, 0U);
  return sides.open_site_count();
}

TEST(SignSides, AreThoseOfTheFullSumOnMeshesThatCrossTouchAndFold) {
  const TriangleMesh sphere = make_sphere({.frequency = 6});
  TriangleMesh crossing = sphere;
  append(crossing, sphere, {0.7, 0.2, 0.1});
  append(crossing, sphere, {0.2, 0.8, 0.1});
  TriangleMesh nested = sphere;  // a shell within another one that faces the same way, so the winding number is 2
  append(nested, moved_by(make_box({.size = {0.3, 0.3, 0.3}}), {0.1, 0, 0}));
  TriangleMesh coincident = make_box({});
  append(coincident, make_box({}));
  // A box touches three others, but only in edges and a corner.
  TriangleMesh corner = test::box_between({0, 0, 0}, {1, 1, 1});
  append(corner, test::box_between({1, 1, 0}, {2, 2, 1}));
  append(corner, test::box_between({1, 0, 1}, {2, 1, 2}));
  TriangleMesh crumpled = make_sphere({.frequency = 4});
  Random random(4);
  for (Vec3d& v : crumpled.vertices) v += random.in_ball() * 0.3;
  std::uint64_t seed = 1;
  for (TriangleMesh mesh : {crossing, nested, coincident, corner, crumpled, barely_crossing()}) {
    SCOPED_TRACE(seed);
    for (const SignMode mode : {SignMode::automatic, SignMode::winding}) (void)expect_true_sides(mesh, mode, seed++);
    reverse_triangles(mesh);
    (void)expect_true_sides(mesh, SignMode::winding, seed++);
  }
}

TEST(SignSides, AskForWindingNumbersOnlyBesideCrossings) {
  TriangleMesh crossing = make_sphere({.frequency = 20});
  append(crossing, make_sphere({.frequency = 20}), {0.7, 0.2, 0.1});
  EXPECT_LT(expect_true_sides(crossing, SignMode::automatic, 1), SiteTable(crossing).size() / 20);
  EXPECT_EQ(expect_true_sides(make_sphere({.frequency = 8}), SignMode::winding, 2), 0U);
  TriangleMesh open = make_sphere({.frequency = 8});
  open.triangles.pop_back();
  EXPECT_EQ(expect_true_sides(open, SignMode::winding, 3), 0U);  // the method is sums, which needs no sites
}

}  // namespace
}  // namespace blum
