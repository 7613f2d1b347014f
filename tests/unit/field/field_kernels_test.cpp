// Proves the CUDA back end: on the first CUDA device where there is one, and anywhere on the host, where the same
// bodies, blocks and lists run as loops. Fields keep the precision promise on every generated shape and on soups made
// to break float32, whatever the slabs, bands and list sizes; connectivity is SiteTable's; images are the CPU's, byte
// for byte.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <optional>

#include "blum/core/random.hpp"
#include "blum/field/distance_transform.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/generators.hpp"
#include "blum/geometry/shape_catalog.hpp"
#include "field/backend.hpp"
#include "support/emulated_backend.hpp"
#include "support/field_check.hpp"
#include "support/nasty_soup.hpp"

namespace blum {
namespace {

GridSpec grid_for(const MeshView& mesh, int nodes) {
  return grid_around(bounds(mesh), nodes, 0.1);
}

enum class Where : std::uint8_t { host, device };

class FieldKernels : public testing::TestWithParam<Where> {
 protected:
  void SetUp() override {
    if (GetParam() == Where::host) {
      emulated_.emplace();
      return;
    }
    try {
      (void)make_field_backend({.device = Device::cuda()});
    } catch (const DeviceError& error) {
      GTEST_SKIP() << error.what();
    }
  }

  static Field compute(const MeshView& mesh, const GridSpec& grid,
                       const FieldOptions& options = {.sign = SignMode::none}) {
    return distance_field(mesh, grid, options, {.threads = 2, .device = Device::cuda()});
  }

  static void expect_exact(const MeshView& mesh, const GridSpec& grid,
                           const FieldOptions& options = {.sign = SignMode::none}) {
    const Field field = compute(mesh, grid, options);
    EXPECT_EQ(field.device, Device::cuda());
    expect_promise(test::compare_with_bvh(field, mesh, test::all_nodes(grid)));
    expect_promise(test::compare_with_brute_force(field, mesh, test::random_nodes(grid, 50)));
  }

 private:
  std::optional<test::EmulatedCuda> emulated_;
};

INSTANTIATE_TEST_SUITE_P(On, FieldKernels, testing::Values(Where::host, Where::device),
                         [](const auto& info) { return info.param == Where::host ? "Host" : "Device"; });

bool same_bytes(const Field& a, const Field& b) {
  return a.distance.size() == b.distance.size() &&
         std::memcmp(a.distance.data(), b.distance.data(), a.distance.span().size_bytes()) == 0 &&
         std::memcmp(a.site.data(), b.site.data(), a.site.span().size_bytes()) == 0;
}

TEST_P(FieldKernels, KeepThePromiseOnEveryGeneratedShape) {
  for (const ShapeInfo& shape : shape_catalog()) {
    SCOPED_TRACE(shape.name);
    const TriangleMesh mesh = make_shape(shape.name);
    const bool is_solid = shape.betti(complete_parameters(shape, {})).has_value();
    expect_exact(mesh, grid_for(mesh, 24), {.sign = is_solid ? SignMode::automatic : SignMode::none});
  }
}

TEST_P(FieldKernels, KeepThePromiseOnNastySoups) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const TriangleMesh mesh = test::nasty_soup(seed, 40 * seed);
    expect_exact(mesh, grid_for(mesh, 32));
  }
}

TEST_P(FieldKernels, KeepThePromiseOnPointsAndSegments) {
  const TriangleMesh points = make_points();
  const TriangleMesh segments = make_segments();
  expect_exact(points, grid_for(points, 32));
  expect_exact(segments, grid_for(segments, 32));
  TriangleMesh mixed = make_box({});
  mixed.vertices.push_back({3, 0, 0});
  mixed.vertices.push_back({0, 3, 0});
  mixed.segments.push_back({0, static_cast<std::uint32_t>(mixed.vertices.size() - 1)});
  mixed.points.push_back(static_cast<std::uint32_t>(mixed.vertices.size() - 2));
  expect_exact(mixed, grid_for(mixed, 32));
}

TEST_P(FieldKernels, OnePointIsEnough) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 2, 3}};
  mesh.points = {0};
  expect_exact(mesh, {.origin = {0, 0, 0}, .spacing = {1, 1, 1}, .size = {5, 9, 17}});
}

TEST_P(FieldKernels, VerticesThatNothingNamesAreNoSites) {
  TriangleMesh mesh = make_sphere({.frequency = 4});
  mesh.vertices.insert(mesh.vertices.begin(), {0, 0, 0});
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) ++v;
  }
  expect_exact(mesh, grid_for(mesh, 24));
}

TEST_P(FieldKernels, SignsAreThoseOfEveryRule) {
  TriangleMesh open = make_sphere({.frequency = 6});
  std::erase_if(open.triangles, [&](const Triangle& t) { return open.vertices[t[0]].z > 0.2; });
  expect_exact(open, grid_for(open, 20), {.sign = SignMode::winding});
  const TriangleMesh closed = make_gear({});
  expect_exact(closed, grid_for(closed, 24), {.sign = SignMode::normals});
  // Shells that face different ways leave signs to the pseudonormals alone.
  TriangleMesh shells = make_box({.size = {2, 2, 2}});
  const TriangleMesh inner = make_box({.size = {1, 1, 1}});
  const auto first = static_cast<std::uint32_t>(shells.vertices.size());
  shells.vertices.insert(shells.vertices.end(), inner.vertices.begin(), inner.vertices.end());
  for (const Triangle& t : inner.triangles) shells.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  const GridSpec grid = grid_for(shells, 20);
  const Field cpu = distance_field(shells, grid, {.sign = SignMode::normals});
  const Field device = compute(shells, grid, {.sign = SignMode::normals});
  for (std::size_t k = 0; k < cpu.distance.size(); ++k) {
    ASSERT_EQ(std::signbit(cpu.distance[k]), std::signbit(device.distance[k])) << k;
  }
}

/// Adds a shape, moved, to a mesh.
void add(TriangleMesh& to, const TriangleMesh& mesh, const Vec3d& offset, bool is_turned = false) {
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  for (const Vec3d& v : mesh.vertices) to.vertices.push_back(v + offset);
  for (const Triangle& t : mesh.triangles) {
    to.triangles.push_back({t[0] + first, t[is_turned ? 2 : 1] + first, t[is_turned ? 1 : 2] + first});
  }
}

TEST_P(FieldKernels, CountedCrossingsGiveTheSignsOfTheCpu) {
  std::vector<TriangleMesh> meshes{make_box({}), make_gear({})};
  TriangleMesh inverted;
  add(inverted, make_gear({}), {}, true);
  meshes.push_back(inverted);
  meshes.push_back(make_box({}));
  add(meshes.back(), make_box({}), {0.3, 0.2, 0.1});
  const std::size_t crossing = meshes.size() - 1;
  TriangleMesh hollow = make_box({.size = {2, 2, 2}});
  add(hollow, make_sphere({.frequency = 5}), {}, true);
  meshes.push_back(hollow);
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
          if (std::abs(cpu.distance[k]) <= 1e-6 * diagonal) continue;  // on the surface, where nothing is promised
          ASSERT_EQ(std::signbit(cpu.distance[k]), std::signbit(device.distance[k])) << k << " " << cpu.distance[k];
        }
      }
    }
  }
}

/// Fails where a sign is not that of the full sum over all triangles.
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

/// A sphere without what lies above a height.
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
  // Rows pass through edges and corners of the opening, and run along them.
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
  // Edges run along the same way by two triangles, and by four, count as often.
  TriangleMesh fan = make_box({});
  fan.triangles.insert(fan.triangles.end(), fan.triangles.begin(), fan.triangles.begin() + 5);
  expect_winding_signs(compute(fan, grid_for(fan, 20), {.sign = SignMode::winding}), fan);
  // Triangles that are turned leave surpluses of two.
  TriangleMesh turned = make_sphere({.frequency = 3});
  for (std::size_t t = 0; t < turned.triangles.size(); t += 7)
    std::swap(turned.triangles[t][0], turned.triangles[t][1]);
  expect_winding_signs(compute(turned, grid_for(turned, 20), {.sign = SignMode::winding}), turned);
}

TEST_P(FieldKernels, GridsOfAnyShapeAndDirection) {
  const TriangleMesh mesh = make_torus({});
  const GridSpec cube = grid_for(mesh, 24);
  for (const std::array<std::int64_t, 3>& size :
       std::vector<std::array<std::int64_t, 3>>{{1, 1, 1}, {40, 1, 1}, {1, 33, 7}, {8, 8, 8}, {9, 17, 5}, {3, 2, 65}}) {
    GridSpec grid = cube;
    grid.size = size;
    grid.spacing = {0.07, 0.11, 0.05};
    expect_exact(mesh, grid);
    grid.direction = {{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}};
    expect_exact(mesh, grid);
  }
}

TEST_P(FieldKernels, BandsCutOff) {
  const TriangleMesh mesh = make_torus_knot({.curve_segments = 100, .tube_segments = 8});
  const GridSpec grid = grid_for(mesh, 40);
  for (const double band : {0.01, 0.2, 100.0}) {
    expect_exact(mesh, grid, {.sign = SignMode::automatic, .band = band});
  }
}

TEST_P(FieldKernels, SlabsDoNotChangeABit) {
  const TriangleMesh mesh = make_torus_knot({.curve_segments = 100, .tube_segments = 8});
  GridSpec grid = grid_for(mesh, 24);
  grid.size[2] = 100;
  const Field whole = compute(mesh, grid);
  if (GetParam() == Where::device) GTEST_SKIP() << "slabs of the device have one size; bench/gpu checks others";
  const test::EmulatedCuda cuda(1);  // 32 slices at a time
  const Field slabs = distance_field(mesh, grid, {.sign = SignMode::none}, {.device = Device::cuda()});
  EXPECT_TRUE(same_bytes(whole, slabs));
}

TEST_P(FieldKernels, MoreSitesThanAListHolds) {
  // All of 18,000 triangles matter to the tile in the middle of a sphere, and a list holds 512.
  const TriangleMesh mesh = make_sphere({.frequency = 30});
  const GridSpec grid = grid_in({{-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}}, 12);
  expect_exact(mesh, grid);
}

TEST_P(FieldKernels, TiesGoToTheSmallerSite) {
  TriangleMesh mesh;
  mesh.vertices = {{-1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.points = {3, 2, 1, 0};
  const GridSpec grid{.origin = {0, 0, 0}, .spacing = {0.25, 1, 1}, .size = {5, 1, 1}};
  const Field field = compute(mesh, grid);
  EXPECT_EQ(field.site[0].value, 0U);
  EXPECT_EQ(field.site[4].value, 1U);
}

TEST_P(FieldKernels, ExtentsThatFloatsDoNotHoldAreRefused) {
  const TriangleMesh mesh = make_box({});
  GridSpec grid = grid_for(mesh, 8);
  grid.spacing = {1e37, 1e37, 1e37};
  EXPECT_THROW((void)compute(mesh, grid), InvalidGrid);
}

TEST_P(FieldKernels, CancelledWhereAskedTo) {
  std::stop_source stop;
  stop.request_stop();
  const TriangleMesh mesh = make_box({});
  EXPECT_THROW(
      (void)distance_field(mesh, grid_for(mesh, 8), {}, {.cancel = stop.get_token(), .device = Device::cuda()}),
      Cancelled);
}

TEST_P(FieldKernels, TransformsOfImagesAreThoseOfTheCpu) {
  Random random(5);
  for (const std::array<std::int64_t, 3>& size : std::vector<std::array<std::int64_t, 3>>{{33, 20, 17}, {70, 1, 5}}) {
    VoxelImage image;
    image.grid.size = size;
    image.grid.spacing = {1, 0.7, 2.1};
    std::vector<std::int16_t> values(image.grid.node_count());
    for (auto& value : values) value = static_cast<std::int16_t>(random.below(30) / 9);
    image.values = std::move(values);
    const std::vector<LabelSelection> selections{LabelSelection::of_label(3), LabelSelection::at_least(1)};
    for (const DistanceTransformOptions& options :
         {DistanceTransformOptions{}, DistanceTransformOptions{.is_signed = false, .band = 1.5}}) {
      const std::vector<Field> cpu = distance_transforms(image, selections, options);
      const std::vector<Field> device = distance_transforms(image, selections, options, {.device = Device::cuda()});
      ASSERT_EQ(cpu.size(), device.size());
      for (std::size_t k = 0; k < cpu.size(); ++k) {
        EXPECT_EQ(device[k].device, Device::cuda());
        EXPECT_EQ(cpu[k].sign_reason, device[k].sign_reason);
        EXPECT_TRUE(same_bytes(cpu[k], device[k]));
      }
    }
    EXPECT_THROW(
        (void)distance_transform(image, {.selection = LabelSelection::of_label(9)}, {.device = Device::cuda()}),
        InvalidImage);
  }
}

TEST(Connectivity, IsThatOfSiteTable) {
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

TEST_P(FieldKernels, SolverFollowsADeformingMeshAndANewOne) {
  TriangleMesh mesh = make_torus_knot({.curve_segments = 100, .tube_segments = 8});
  const GridSpec grid = grid_around(bounds(mesh), 24, 0.3);
  FieldSolver solver(grid, {}, {.device = Device::cuda()});
  for (int frame = 0; frame < 3; ++frame) {
    for (Vec3d& v : mesh.vertices) v.x *= 1.1;
    expect_promise(test::compare_with_bvh(solver.compute(mesh), mesh, test::all_nodes(grid)));
  }
  const TriangleMesh other = make_gear({});
  expect_promise(test::compare_with_bvh(solver.compute(other), other, test::all_nodes(grid)));
}

}  // namespace
}  // namespace blum
