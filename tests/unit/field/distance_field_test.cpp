// Proves the promises of distance_field() other than exactness on every back end. Bytes are the same for any number of
// threads and in every run. Bands, sign rules, solvers, cancellation and errors work as documented. On the CPU, all
// instruction sets agree.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <optional>
#include <thread>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/field/field.hpp"
#include "blum/shapes/generators.hpp"
#include "field/cpu/tile_kernel.hpp"
#include "support/back_ends.hpp"
#include "support/field_check.hpp"

namespace blum {
namespace {

GridSpec grid_for(const MeshView& mesh, int nodes) {
  return grid_around(bounds(mesh), nodes, 0.1);
}

TriangleMesh inverted(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// Returns a sphere without its top.
TriangleMesh open_bowl() {
  TriangleMesh mesh = make_sphere({});
  std::erase_if(mesh.triangles, [&](const Triangle& t) { return mesh.vertices[t[0]].z > 0.2; });
  return mesh;
}

class DistanceField : public test::BackEndTest {
 protected:
  [[nodiscard]] Field compute(const MeshView& mesh, const GridSpec& grid, const FieldOptions& options = {},
                              const Context& how = {}) const {
    Field field = distance_field(mesh, grid, options, context(how));
    EXPECT_EQ(field.device, device());
    return field;
  }
};

INSTANTIATE_TEST_SUITE_P(On, DistanceField, test::every_back_end(), test::back_end_name);

TEST_P(DistanceField, SameBytesOnAnyNumberOfThreads) {
  const TriangleMesh mesh = make_torus_knot({});
  for (const SignMode sign : {SignMode::none, SignMode::normals, SignMode::winding}) {
    const GridSpec grid = grid_for(mesh, usually(100, 40));
    const Field one = compute(mesh, grid, {.sign = sign}, {.threads = 1});
    for (const int threads : {1, 2, 7}) {
      EXPECT_TRUE(test::same_bytes(one, compute(mesh, grid, {.sign = sign}, {.threads = threads}))) << threads;
    }
  }
}

TEST(DistanceFieldOnTheCpu, EveryInstructionSetKeepsThePromise) {
  SoupOptions options;
  options.triangles = 300;
  options.awkward = 0.5;
  const TriangleMesh soup = make_soup(options);
  const TriangleMesh solid = make_gear({});
  const std::vector<std::string> targets = cpu::simd_targets();
  EXPECT_FALSE(targets.empty());
  for (const std::string& target : targets) {
    SCOPED_TRACE(target);
    cpu::use_simd_target(target);
    for (const TriangleMesh* mesh : {&soup, &solid}) {
      const GridSpec grid = grid_for(*mesh, 40);
      const Field field = distance_field(*mesh, grid, {.sign = mesh == &solid ? SignMode::normals : SignMode::none});
      expect_promise(test::compare_with_bvh(field, *mesh, test::all_nodes(grid)));
    }
  }
  cpu::use_simd_target("");
}

TEST_P(DistanceField, BandsEqualTheFullFieldWithinAndAreClampedBeyond) {
  const TriangleMesh mesh = make_gear({});
  const GridSpec grid = grid_for(mesh, 80);
  for (const SignMode sign : {SignMode::none, SignMode::normals, SignMode::winding}) {
    const Field full = compute(mesh, grid, {.sign = sign});
    const double band = 3 * grid.spacing.x;
    const Field banded = compute(mesh, grid, {.sign = sign, .band = band});
    std::size_t beyond = 0;
    for (std::size_t k = 0; k < full.distance.size(); ++k) {
      const float limit = static_cast<float>(band);
      ASSERT_EQ(std::signbit(full.distance[k]), std::signbit(banded.distance[k])) << k;
      if (std::abs(full.distance[k]) <= limit) {
        ASSERT_EQ(full.distance[k], banded.distance[k]) << k;
        ASSERT_EQ(full.site[k], banded.site[k]) << k;
      } else {
        ASSERT_EQ(std::abs(banded.distance[k]), limit) << k;
        ASSERT_FALSE(banded.site[k].has_value()) << k;
        ++beyond;
      }
    }
    EXPECT_GT(beyond, full.distance.size() / 10);
    EXPECT_LT(beyond, full.distance.size());
  }
}

/// Returns two shells, one facing outwards and one inwards. For these, `normals` uses pseudonormals.
TriangleMesh two_minds() {
  TriangleMesh mesh = make_box({});
  append(mesh, inverted(make_sphere({.frequency = 4})), {3, 0.3, 0.2});
  return mesh;
}

void expect_same_without_sites(const Field& with, const Field& without) {
  EXPECT_TRUE(without.site.empty());
  ASSERT_EQ(with.distance.size(), without.distance.size());
  EXPECT_EQ(0, std::memcmp(with.distance.data(), without.distance.data(), with.distance.span().size_bytes()));
  EXPECT_EQ(with.sign_rule, without.sign_rule);
  EXPECT_EQ(with.sign_reason, without.sign_reason);
}

TEST_P(DistanceField, WithoutSitesDistancesAreTheSameBytes) {
  struct Case {
    TriangleMesh mesh;
    SignMode sign;
    int nodes;
  };
  // The first grid is so large that its values are written past the caches.
  for (const Case& c : {Case{make_sphere({}), SignMode::automatic, usually(136, 40)},
                        {make_gear({}), SignMode::none, 30},
                        {make_gear({}), SignMode::winding, 30},
                        {open_bowl(), SignMode::automatic, 24},
                        {two_minds(), SignMode::normals, 40}}) {
    const GridSpec grid = grid_for(c.mesh, c.nodes);
    for (const std::optional<double> band : {std::optional<double>{}, std::optional<double>{3 * grid.spacing.x}}) {
      FieldOptions options{.sign = c.sign, .band = band};
      const Field with = compute(c.mesh, grid, options);
      options.sites = false;
      expect_same_without_sites(with, compute(c.mesh, grid, options));
    }
  }
}

TEST_P(DistanceField, SolversWithAndWithoutSitesFollowAMeshAlike) {
  TriangleMesh mesh = two_minds();
  const GridSpec grid = grid_around(bounds(mesh), 24, 0.3);
  for (const SignMode sign : {SignMode::automatic, SignMode::normals}) {
    FieldSolver with(grid, {.sign = sign, .band = 0.4}, context());
    FieldSolver without(grid, {.sign = sign, .band = 0.4, .site_ids = SiteIds::triangles, .sites = false}, context());
    for (int frame = 0; frame < 4; ++frame) {
      for (Vec3d& v : mesh.vertices) v.x += 0.03 * v.y;
      if (frame == 3) std::swap(mesh.triangles.front(), mesh.triangles.back());
      expect_same_without_sites(with.compute(mesh), without.compute(mesh));
      if (frame == 1) expect_same_without_sites(with.take(), without.take());
    }
  }
}

TEST_P(DistanceField, AutomaticSignSaysWhichRuleAndWhy) {
  const auto rule_of = [&](const MeshView& mesh) {
    const Field field = compute(mesh, grid_for(mesh, 24));
    EXPECT_FALSE(field.sign_reason.empty());
    return field.sign_rule;
  };
  EXPECT_EQ(rule_of(make_sphere({})), SignRule::normals);
  EXPECT_EQ(rule_of(make_void_cube({})), SignRule::normals);
  EXPECT_EQ(rule_of(open_bowl()), SignRule::winding);
  EXPECT_EQ(rule_of(inverted(make_sphere({}))), SignRule::normals);
  EXPECT_EQ(rule_of(make_points({})), SignRule::none);
}

TEST_P(DistanceField, AMeshThatCrossesItselfFallsBackToWinding) {
  // Two boxes overlap, each valid by itself. In the overlap, their pseudonormals contradict each other.
  TriangleMesh mesh = make_box({});
  const TriangleMesh other = make_box({});
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3d& v : other.vertices) mesh.vertices.push_back(v + Vec3d{0.4, 0.3, 0.2});
  for (const Triangle& t : other.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  const GridSpec grid = grid_for(mesh, 48);
  const Field field = compute(mesh, grid);
  EXPECT_EQ(field.sign_rule, SignRule::winding);
  expect_promise(test::compare_with_brute_force(field, mesh, test::all_nodes(grid)));
}

TEST_P(DistanceField, OpenMeshesAreSignedNodeByNode) {
  const TriangleMesh mesh = open_bowl();
  const GridSpec grid = grid_for(mesh, usually(32, 20));
  const Field field = compute(mesh, grid, {.sign = SignMode::winding});
  expect_promise(test::compare_with_brute_force(field, mesh, test::all_nodes(grid)));
}

TEST_P(DistanceField, InvertedMeshesHaveNoInsideByWindingAndSwapSidesByNormals) {
  const TriangleMesh mesh = inverted(make_sphere({}));
  const GridSpec grid = grid_for(mesh, 24);
  const Field winding = compute(mesh, grid, {.sign = SignMode::winding});
  for (const float distance : winding.distance) ASSERT_GE(distance, 0.0F);
  const Field normals = compute(mesh, grid, {.sign = SignMode::normals});
  EXPECT_LT(normals.distance[0], 0.0F);
}

TEST_P(DistanceField, TriangleIdsNameATriangleAtTheDistance) {
  const TriangleMesh mesh = make_torus({});
  const GridSpec grid = grid_for(mesh, 32);
  const Field field = compute(mesh, grid, {.site_ids = SiteIds::triangles});
  EXPECT_EQ(field.site_ids, SiteIds::triangles);
  for (std::size_t k = 0; k < field.site.size(); ++k) {
    ASSERT_LT(field.site[k].value, mesh.triangles.size());
    const Triangle& t = mesh.triangles[field.site[k].value];
    const double distance = reference::triangle_distance(test::node_position(grid, k), mesh.vertices[t[0]],
                                                         mesh.vertices[t[1]], mesh.vertices[t[2]]);
    ASSERT_NEAR(distance, std::abs(field.distance[k]), 1e-5);
  }
  EXPECT_THROW((void)compute(make_points({}), grid, {.site_ids = SiteIds::triangles}), InvalidOption);
}

TEST_P(DistanceField, SolverFollowsADeformingMeshAndChangesOfTopology) {
  TriangleMesh mesh = make_torus({});
  const GridSpec grid = grid_for(mesh, 40);
  FieldSolver solver(grid, {.sign = SignMode::automatic}, context());
  for (int frame = 0; frame < 4; ++frame) {
    for (Vec3d& v : mesh.vertices) v.z *= 1 + 0.1 * std::sin(v.x + frame);
    if (frame == 2) mesh.triangles.resize(mesh.triangles.size() / 2);
    if (frame == 3) mesh = make_sphere({});
    EXPECT_TRUE(test::same_bytes(solver.compute(mesh), compute(mesh, grid))) << frame;
  }
  const Field taken = solver.take();
  EXPECT_TRUE(test::same_bytes(taken, solver.compute(mesh)));
}

TEST_P(DistanceField, SolverStaysUsableAfterAnError) {
  const TriangleMesh mesh = make_box({});
  FieldSolver solver(grid_for(mesh, 16), {}, context());
  TriangleMesh broken = mesh;
  broken.triangles[3][1] = 1000;
  EXPECT_THROW((void)solver.compute(broken), InvalidMesh);
  TriangleMesh huge = mesh;
  for (Vec3d& v : huge.vertices) v *= 1e40;
  EXPECT_THROW((void)solver.compute(huge), InvalidGrid);
  EXPECT_TRUE(test::same_bytes(solver.compute(mesh), compute(mesh, grid_for(mesh, 16))));
}

TEST(DistanceFieldOnTheCpu, StopsSoonAfterItIsAsked) {
  const TriangleMesh mesh = make_torus_knot({});
  const GridSpec grid = grid_for(mesh, 400);
  std::stop_source source;
  auto asked = std::chrono::steady_clock::now();
  std::jthread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
    asked = std::chrono::steady_clock::now();
    source.request_stop();
  });
  EXPECT_THROW((void)distance_field(mesh, grid, {.sign = SignMode::winding}, {.cancel = source.get_token()}),
               Cancelled);
  canceller.join();
  const std::chrono::duration<double> delay = std::chrono::steady_clock::now() - asked;
  EXPECT_LT(delay.count(), 5.0);  // 0.2 s is promised; a busy machine and sanitizers need more, and a hang fails
}

TEST_P(DistanceField, ReportsProgress) {
  const TriangleMesh mesh = make_torus({});
  double last = 0;
  Context how;
  how.progress = [&](double fraction, std::string_view phase) {
    if (phase == "field") last = fraction;
  };
  (void)compute(mesh, grid_for(mesh, 100), {}, how);
  EXPECT_EQ(last, 1.0);
}

TEST_P(DistanceField, RejectsInvalidInput) {
  const TriangleMesh box = make_box({});
  const GridSpec grid = grid_for(box, 16);
  EXPECT_THROW((void)compute(TriangleMesh{}, grid), InvalidMesh);
  TriangleMesh broken = box;
  broken.vertices[2].y = std::nan("");
  EXPECT_THROW((void)compute(broken, grid), InvalidMesh);
  EXPECT_THROW((void)compute(box, GridSpec{}), InvalidGrid);
  GridSpec huge = grid;
  huge.spacing = {1e38, 1e38, 1e38};
  EXPECT_THROW((void)compute(box, huge), InvalidGrid);
  huge = grid;
  huge.size = {1 << 14, 1 << 13, 1 << 13};
  EXPECT_THROW((void)compute(box, huge), OutOfMemory);
  EXPECT_THROW((void)compute(box, grid, {.band = -1.0}), InvalidOption);
  EXPECT_THROW((void)compute(box, grid, {.band = std::nan("")}), InvalidOption);
  EXPECT_THROW((void)compute(box, grid, {.site_ids = SiteIds::voxels}), InvalidOption);
  EXPECT_THROW((void)compute(box, grid, {}, {.threads = -3}), InvalidOption);
  EXPECT_THROW((void)compute(open_bowl(), grid, {.sign = SignMode::normals}), InvalidMesh);
  EXPECT_THROW((void)compute(make_points({}), grid, {.sign = SignMode::winding}), InvalidOption);
}

TEST_P(DistanceField, RefusesExtentsThatFloat32CannotHold) {
  for (const double scale : {1e-38, 1e-165, 1e-300, 1e40, 1e145}) {
    TriangleMesh mesh = make_box({});
    for (Vec3d& p : mesh.vertices) p *= scale;
    GridSpec grid;
    grid.size = {3, 3, 3};
    grid.spacing = Vec3d{0.5, 0.5, 0.5} * scale;
    EXPECT_THROW((void)compute(mesh, grid), InvalidGrid) << scale;
  }
}

TEST_P(DistanceField, SolverIsCancelledByTheContextOfAFrameAloneAndStaysUsable) {
  const TriangleMesh mesh = make_sphere();
  const GridSpec grid = grid_around(bounds(mesh), 24);
  FieldSolver solver(grid, {}, context());
  std::stop_source stop;
  stop.request_stop();
  Context cancelled;
  cancelled.cancel = stop.get_token();
  EXPECT_THROW(static_cast<void>(solver.compute(mesh, cancelled)), Cancelled);
  const Field expected = compute(mesh, grid);
  const Field& field = solver.compute(mesh);
  EXPECT_TRUE(std::equal(field.distance.begin(), field.distance.end(), expected.distance.begin()));
}

}  // namespace
}  // namespace blum
