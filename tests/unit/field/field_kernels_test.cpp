// Proves properties that only the CUDA back end has. Signs of closed meshes equal those of the CPU; signs of open
// meshes equal those of the full sum. Slabs, and lists too short for a tile, do not change a field. A cancelled field
// stops after the current slab. The connectivity equals SiteTable's.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/field/field.hpp"
#include "blum/shapes/generators.hpp"
#include "field/kernels/boundary_signs.hpp"
#include "field/kernels/connectivity.hpp"
#include "field/kernels/emulated_device.hpp"
#include "support/back_ends.hpp"
#include "support/field_check.hpp"
#include "support/nasty_soup.hpp"

namespace blum {
namespace {

GridSpec grid_for(const MeshView& mesh, int nodes) {
  return grid_around(bounds(mesh), nodes, 0.1);
}

class FieldKernels : public test::BackEndTest {
 protected:
  [[nodiscard]] Field compute(const MeshView& mesh, const GridSpec& grid,
                              const FieldOptions& options = {.sign = SignMode::none}) const {
    return distance_field(mesh, grid, options, context({.threads = 2}));
  }
};

INSTANTIATE_TEST_SUITE_P(On, FieldKernels, test::cuda_back_ends(), test::back_end_name);

TEST_P(FieldKernels, SidesByPseudonormalsAreThoseOfTheCpu) {
  // Shells that face different ways leave all signs to the pseudonormals.
  TriangleMesh shells = make_box({.size = {2, 2, 2}});
  append(shells, make_box({.size = {1, 1, 1}}));
  const GridSpec grid = grid_for(shells, 20);
  const Field cpu = distance_field(shells, grid, {.sign = SignMode::normals});
  const Field device = compute(shells, grid, {.sign = SignMode::normals});
  for (std::size_t k = 0; k < cpu.distance.size(); ++k) {
    ASSERT_EQ(std::signbit(cpu.distance[k]), std::signbit(device.distance[k])) << k;
  }
}

TriangleMesh turned(TriangleMesh mesh) {
  reverse_triangles(mesh);
  return mesh;
}

TEST_P(FieldKernels, CountedCrossingsGiveTheSignsOfTheCpu) {
  std::vector<TriangleMesh> meshes{make_box({}), make_gear({}), turned(make_gear({})), make_box({})};
  const std::size_t crossing = meshes.size() - 1;
  append(meshes.back(), make_box({}), {0.3, 0.2, 0.1});
  meshes.push_back(make_box({.size = {2, 2, 2}}));
  append(meshes.back(), turned(make_sphere({.frequency = 5})));
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const TriangleMesh& mesh = meshes[m];
    for (const SignMode sign : {SignMode::automatic, SignMode::winding, SignMode::normals}) {
      if (m == crossing && sign == SignMode::normals) continue;  // not defined where shells cross
      GridSpec grid = grid_for(mesh, 41);
      for (const bool is_mirrored : {false, true}) {
        if (is_mirrored) grid.direction = {{{0, 1, 0}, {1, 0, 0}, {0, 0, 1}}};
        SCOPED_TRACE(testing::Message() << mesh.triangles.size() << " triangles, " << to_string(sign)
                                        << (is_mirrored ? ", mirrored" : ""));
        const Field cpu = distance_field(mesh, grid, {.sign = sign});
        const Field device = compute(mesh, grid, {.sign = sign});
        EXPECT_EQ(cpu.sign_rule, device.sign_rule);
        EXPECT_EQ(cpu.sign_reason, device.sign_reason);
        const double diagonal = test::common_diagonal(mesh, grid);
        for (std::size_t k = 0; k < cpu.distance.size(); ++k) {
          if (std::abs(cpu.distance[k]) <= 1e-6 * diagonal) continue;  // on the surface, where no sign is promised
          ASSERT_EQ(std::signbit(cpu.distance[k]), std::signbit(device.distance[k])) << k << " " << cpu.distance[k];
        }
      }
    }
  }
}

/// Fails if a sign differs from that of the full sum over all triangles.
void expect_winding_signs(const Field& field, const MeshView& mesh) {
  const double diagonal = test::common_diagonal(mesh, field.grid);
  std::size_t wrong = 0;
  for (const std::size_t node : test::all_nodes(field.grid)) {
    if (std::abs(field.distance[node]) <= 1e-6 * diagonal) continue;
    const double winding = reference::winding_number(mesh, test::node_position(field.grid, node));
    if (std::abs(winding - 0.5) < 1e-9) continue;
    wrong += std::signbit(field.distance[node]) != (winding > 0.5) ? 1 : 0;
  }
  EXPECT_EQ(wrong, 0U);
}

/// Returns a sphere without the part above a height.
TriangleMesh bowl(double height) {
  TriangleMesh mesh = make_sphere({.frequency = 8});
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return mesh.vertices[t[0]].z > height && mesh.vertices[t[1]].z > height && mesh.vertices[t[2]].z > height;
  });
  return mesh;
}

TEST_P(FieldKernels, SignsOfOpenMeshesAreThoseOfTheFullSum) {
  for (const double height : {-0.5, 0.0, 0.8, 0.95}) {
    SCOPED_TRACE(height);
    const TriangleMesh mesh = bowl(height);
    for (const double band : {0.0, 0.1}) {
      FieldOptions options{.sign = SignMode::winding};
      if (band > 0) options.band = band;
      expect_winding_signs(compute(mesh, grid_around(bounds(mesh), 26, 0.3), options), mesh);
    }
  }
}

TEST_P(FieldKernels, SignsOfOpenMeshesWhoseEdgesLieOnTheGrid) {
  // Rows pass through edges and corners of the opening, and along its edges.
  for (std::size_t missing = 0; missing < 12; ++missing) {
    SCOPED_TRACE(missing);
    TriangleMesh mesh = make_box({.size = {2, 2, 2}});
    mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(missing));
    GridSpec grid{.origin = {-2, -2, -2}, .spacing = {0.25, 0.25, 0.25}, .size = {17, 17, 17}};
    expect_winding_signs(compute(mesh, grid, {.sign = SignMode::winding}), mesh);
    grid.direction = {{{0, 1, 0}, {0, 0, 1}, {-1, 0, 0}}};  // mirrored
    grid.origin = {2, -2, -2};
    expect_winding_signs(compute(mesh, grid, {.sign = SignMode::winding}), mesh);
    grid.spacing = {0.25, 0.5, 0.125};
    grid.size = {17, 9, 33};
    expect_winding_signs(compute(mesh, grid, {.sign = SignMode::winding}), mesh);
  }
}

TEST_P(FieldKernels, SignsOfSoupsAreThoseOfTheFullSum) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    TriangleMesh mesh = test::nasty_soup(seed, 60);
    mesh.segments.clear();
    mesh.points.clear();
    if (mesh.triangles.empty()) continue;
    expect_winding_signs(compute(mesh, grid_for(mesh, 20), {.sign = SignMode::winding}), mesh);
  }
  // Two or four triangles run along an edge in the same direction; the edge counts as often.
  TriangleMesh fan = make_box({});
  fan.triangles.insert(fan.triangles.end(), fan.triangles.begin(), fan.triangles.begin() + 5);
  expect_winding_signs(compute(fan, grid_for(fan, 20), {.sign = SignMode::winding}), fan);
  // Each reversed triangle leaves a surplus of two.
  TriangleMesh mixed = make_sphere({.frequency = 3});
  for (std::size_t t = 0; t < mixed.triangles.size(); t += 7) std::swap(mixed.triangles[t][0], mixed.triangles[t][1]);
  expect_winding_signs(compute(mixed, grid_for(mixed, 20), {.sign = SignMode::winding}), mixed);
}

/// Returns triangles whose corners lie on rows and columns of unit nodes, or one ulp beside them.
TriangleMesh beside_rows(std::uint64_t seed) {
  Random random(seed);
  const auto coordinate = [&] {
    const double whole = static_cast<double>(random.below(12)) - 2;
    const std::uint64_t kind = random.below(4);
    if (kind == 0) return std::nextafter(whole, 100.0);
    if (kind == 1) return std::nextafter(whole, -100.0);
    return kind == 2 ? whole : whole + random.uniform();
  };
  TriangleMesh mesh;
  for (std::uint64_t k = 0; k < 3 + random.below(10); ++k) {
    mesh.vertices.push_back({coordinate(), coordinate(), coordinate()});
  }
  const auto corner = [&] { return static_cast<std::uint32_t>(random.below(mesh.vertices.size())); };
  for (std::uint64_t k = 0; k < 1 + random.below(15); ++k) mesh.triangles.push_back({corner(), corner(), corner()});
  return mesh;
}

TEST_P(FieldKernels, SignsOfSoupsWhoseCornersLieAnUlpBesideRows) {
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE(seed);
    const TriangleMesh mesh = beside_rows(seed);
    GridSpec grid{.size = {8, 8, 8}};
    if (seed % 2 == 0) std::swap(grid.direction.columns[0], grid.direction.columns[seed / 2 % 2 + 1]);
    expect_winding_signs(compute(mesh, grid, {.sign = SignMode::winding}), mesh);
  }
}

TEST_P(FieldKernels, TrianglesThatShareNoVerticesHaveTheSignsOfThoseThatDo) {
  for (TriangleMesh mesh : {make_sphere({.frequency = 6}), bowl(0.3)}) {
    TriangleMesh apart;
    for (const Triangle& t : mesh.triangles) {
      const auto first = static_cast<std::uint32_t>(apart.vertices.size());
      for (const std::uint32_t corner : t) apart.vertices.push_back(mesh.vertices[corner]);
      apart.triangles.push_back({first, first + 1, first + 2});
    }
    const GridSpec grid = grid_for(mesh, 24);
    expect_winding_signs(compute(apart, grid, {.sign = SignMode::winding}), mesh);
  }
}

TEST(Boundary, MergesCoincidentEdges) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, -0.0, 0}};
  mesh.triangles = {{0, 1, 2}, {4, 3, 5}, {6, 3, 4}};  // the first and the last coincide
  kernels::EmulatedDevice device;
  kernels::Connectivity<kernels::EmulatedDevice> connectivity;
  kernels::build_connectivity(device,
                              {mesh.vertices.data(), mesh.triangles.data(), nullptr, nullptr,
                               static_cast<std::uint32_t>(mesh.vertices.size()), 3, 0, 0},
                              connectivity);
  kernels::Boundary<kernels::EmulatedDevice> boundary(device);
  boundary.set_connectivity(connectivity.view());
  EXPECT_EQ(boundary.count(), 7U);  // an edge is shared by index
  boundary.place(mesh.vertices.data());
  ASSERT_EQ(boundary.download_kept_count(), 5U);
  double counts[2] = {};
  for (std::uint32_t k = 0; k < 5; ++k) {
    const double count = std::abs(boundary.kept()[k].count);
    ASSERT_TRUE(count == 1 || count == 2);
    counts[static_cast<int>(count) - 1] += 1;
  }
  EXPECT_EQ(counts[0], 3);  // two of the second triangle, and the diagonal, which all three triangles share
  EXPECT_EQ(counts[1], 2);
}

TEST_P(FieldKernels, SlabsDoNotChangeABit) {
  const TriangleMesh mesh = make_torus_knot({.curve_segments = 100, .tube_segments = 8});
  GridSpec grid = grid_for(mesh, 24);
  grid.size[2] = 100;
  if (GetParam() == test::BackEnd::device) GTEST_SKIP() << "slabs of the device have one size; bench/gpu checks others";
  const Field whole = compute(mesh, grid);
  const Field whole_signed = compute(mesh, grid, {});
  const test::EmulatedCuda cuda(1);  // 32 slices at a time
  EXPECT_TRUE(test::same_bytes(whole, compute(mesh, grid)));
  EXPECT_TRUE(test::same_bytes(whole_signed, compute(mesh, grid, {})));
}

TEST_P(FieldKernels, MoreSitesThanAListHolds) {
  // All 18,000 triangles matter to the tile in the middle of a sphere, but a list holds only 512.
  const TriangleMesh mesh = make_sphere({.frequency = 30});
  const GridSpec grid = grid_in({{-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}}, 12);
  expect_promise(test::compare_with_bvh(compute(mesh, grid), mesh, test::all_nodes(grid)));
}

TEST_P(FieldKernels, StopAfterTheSlabInWhichTheyAreAsked) {
  const TriangleMesh mesh = make_box({});
  GridSpec grid = grid_for(mesh, 8);
  // The grid has three slabs, of 32 slices on the host and of 2^23 nodes on a device.
  grid.size = usually<std::array<std::int64_t, 3>>({512, 512, 96}, {8, 8, 96});
  std::optional<test::EmulatedCuda> short_slabs;
  if (GetParam() == test::BackEnd::host) short_slabs.emplace(1);
  std::stop_source stop;
  std::vector<double> reports;
  const auto ask = [&](double fraction, std::string_view) {
    reports.push_back(fraction);
    stop.request_stop();
  };
  EXPECT_THROW((void)distance_field(mesh, grid, {}, context({.progress = ask, .cancel = stop.get_token()})), Cancelled);
  EXPECT_EQ(reports, std::vector<double>{1.0 / 3});
}

TEST(Connectivity, EqualsThatOfSiteTable) {
  for (const TriangleMesh& mesh : {make_gear({}), test::nasty_soup(3, 60), make_segments()}) {
    kernels::EmulatedDevice device;
    kernels::Connectivity<kernels::EmulatedDevice> found;
    kernels::build_connectivity(
        device,
        {mesh.vertices.data(), mesh.triangles.data(), mesh.segments.data(), mesh.points.data(),
         static_cast<std::uint32_t>(mesh.vertices.size()), static_cast<std::uint32_t>(mesh.triangles.size()),
         static_cast<std::uint32_t>(mesh.segments.size()), static_cast<std::uint32_t>(mesh.points.size())},
        found);
    const SiteTable sites(mesh);
    ASSERT_EQ(found.edge_count, sites.edge_count());
    for (std::size_t e = 0; e < sites.edge_count(); ++e) ASSERT_EQ(found.edges.data()[e], sites.edges()[e]);
  }
}

}  // namespace
}  // namespace blum
