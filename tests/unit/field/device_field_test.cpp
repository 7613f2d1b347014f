// Proves that fields computed in a device's memory have the bytes of fields of meshes in host memory, for all element
// types. Wrong arrays, indices and vertices are rejected. The device is emulated on the host (EmulatedCuda); bench/gpu
// runs similar checks on a real device.
#include "blum/field/device_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/shapes/generators.hpp"
#include "support/emulated_backend.hpp"
#include "support/mesh_places.hpp"

namespace blum {
namespace {

class DeviceField : public testing::Test {
 private:
  test::EmulatedCuda cuda_;
};

template <class T>
constexpr ElementType type_of() {
  if constexpr (std::is_same_v<T, float>) return ElementType::float32;
  if constexpr (std::is_same_v<T, double>) return ElementType::float64;
  if constexpr (std::is_same_v<T, std::int32_t>) return ElementType::int32;
  if constexpr (std::is_same_v<T, std::uint32_t>) return ElementType::uint32;
  return ElementType::int64;
}

/// Holds a mesh in arrays of the given element types.
template <class Real, class Index>
struct Arrays {
  std::vector<Real> vertices;
  std::vector<Index> triangles, segments, points;

  explicit Arrays(const TriangleMesh& mesh) {
    for (const Vec3d& v : mesh.vertices) {
      for (const double x : {v.x, v.y, v.z}) vertices.push_back(static_cast<Real>(x));
    }
    for (const Triangle& t : mesh.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
    for (const Segment& s : mesh.segments) segments.insert(segments.end(), s.begin(), s.end());
    points.assign(mesh.points.begin(), mesh.points.end());
  }
  [[nodiscard]] DeviceMeshView view() const {
    return {{vertices.data(), type_of<Real>(), vertices.size() / 3},
            {triangles.data(), type_of<Index>(), triangles.size() / 3},
            {segments.data(), type_of<Index>(), segments.size() / 2},
            {points.data(), type_of<Index>(), points.size()}};
  }
};

struct Output {
  std::vector<float> distance;
  std::vector<std::uint32_t> site;

  explicit Output(const GridSpec& grid) : distance(grid.node_count(), -7), site(grid.node_count(), 7) {}
  [[nodiscard]] DeviceFieldView view() { return {distance.data(), site.data()}; }
};

void expect_same(const Output& output, const Field& field) {
  ASSERT_EQ(output.distance.size(), field.distance.size());
  EXPECT_EQ(0, std::memcmp(output.distance.data(), field.distance.data(), field.distance.span().size_bytes()));
  EXPECT_EQ(0, std::memcmp(output.site.data(), field.site.data(), field.site.span().size_bytes()));
}

template <class Real, class Index>
void expect_field_of(const TriangleMesh& mesh, const FieldOptions& options = {}) {
  const GridSpec grid = grid_around(bounds(mesh), 20, 0.2);
  const Field field = distance_field(mesh, grid, options, {.device = Device::cuda()});
  const Arrays<Real, Index> arrays(mesh);
  DeviceFieldSolver solver(grid, options);
  Output output(grid);
  solver.set_connectivity(arrays.view());
  solver.compute(arrays.view().vertices, output.view());
  expect_same(output, field);
  EXPECT_EQ(solver.sign_rule() == SignRule::none, field.sign_rule == SignRule::none);
}

TEST_F(DeviceField, EqualsTheHostFieldForAllTypesOfArrays) {
  const TriangleMesh mesh = test::in_single_precision(make_gear({}));
  expect_field_of<double, std::uint32_t>(mesh);
  expect_field_of<float, std::int32_t>(mesh);
  expect_field_of<float, std::int64_t>(mesh);
  expect_field_of<double, std::int64_t>(make_segments());
  expect_field_of<double, std::int32_t>(make_points());
}

TEST_F(DeviceField, TakesTheOptionsOfFields) {
  const TriangleMesh mesh = make_torus({});
  expect_field_of<double, std::int32_t>(mesh, {.sign = SignMode::none});
  expect_field_of<double, std::int32_t>(mesh, {.sign = SignMode::winding, .band = 0.05});
  expect_field_of<double, std::int32_t>(mesh, {.site_ids = SiteIds::triangles});
  expect_field_of<double, std::int32_t>(mesh, {.band = 0.1, .site_ids = SiteIds::triangles});
  TriangleMesh open = make_sphere({.frequency = 6});
  std::erase_if(open.triangles, [&](const Triangle& t) { return open.vertices[t[0]].z > 0.2; });
  expect_field_of<double, std::int32_t>(open);
}

TEST_F(DeviceField, WithoutSitesDistancesAreTheSameBytesAndSitesNeedNoMemory) {
  const TriangleMesh mesh = make_gear({});
  const GridSpec grid = grid_around(bounds(mesh), 20, 0.2);
  const Arrays<double, std::uint32_t> arrays(mesh);
  for (FieldOptions options : {FieldOptions{}, FieldOptions{.band = 0.1, .site_ids = SiteIds::triangles}}) {
    const Field field = distance_field(mesh, grid, options, {.device = Device::cuda()});
    options.sites = false;
    DeviceFieldSolver solver(grid, options);
    solver.set_connectivity(arrays.view());
    for (const bool with_memory : {false, true}) {
      Output output(grid);
      solver.compute(arrays.view().vertices, {output.distance.data(), with_memory ? output.site.data() : nullptr});
      EXPECT_EQ(0, std::memcmp(output.distance.data(), field.distance.data(), field.distance.span().size_bytes()));
      EXPECT_EQ(output.site.front(), 7U);
      EXPECT_EQ(output.site.back(), 7U);
    }
  }
}

TEST_F(DeviceField, FollowsADeformingMeshAndANewOne) {
  TriangleMesh mesh = make_torus({});
  const GridSpec grid = grid_around(bounds(mesh), 20, 0.5);
  DeviceFieldSolver solver(grid);
  EXPECT_EQ(solver.device(), Device::cuda());
  Output output(grid);
  solver.set_connectivity(Arrays<double, std::int32_t>(mesh).view());
  for (int frame = 0; frame < 2; ++frame) {
    for (Vec3d& v : mesh.vertices) v.x *= 1.1;
    const Arrays<double, std::int32_t> arrays(mesh);
    solver.compute(arrays.view().vertices, output.view());
    expect_same(output, distance_field(mesh, grid, {}, {.device = Device::cuda()}));
  }
  const TriangleMesh other = make_gear({});
  const Arrays<double, std::int32_t> arrays(other);
  EXPECT_THROW(solver.compute(arrays.view().vertices, output.view()), InvalidMesh);
  solver.set_connectivity(arrays.view());
  solver.compute(arrays.view().vertices, output.view());
  expect_same(output, distance_field(other, grid, {}, {.device = Device::cuda()}));
  solver.order(nullptr, nullptr);
  EXPECT_GE(solver.progress().queued, 5U);  // two connectivities, three fields
  EXPECT_EQ(solver.progress().finished, solver.progress().queued);
}

TEST_F(DeviceField, InvalidVerticesGiveNoField) {
  const TriangleMesh mesh = make_torus({});
  const GridSpec grid = grid_around(bounds(mesh), 12);
  for (const double wrong : {std::nan(""), std::numeric_limits<double>::infinity(), -1e300, 1e38}) {
    for (const SignMode sign : {SignMode::none, SignMode::automatic}) {
      Arrays<double, std::int32_t> arrays(mesh);
      arrays.vertices[arrays.vertices.size() / 2] = wrong;
      DeviceFieldSolver solver(grid, {.sign = sign});
      solver.set_connectivity(arrays.view());
      Output output(grid);
      solver.compute(arrays.view().vertices, output.view());
      for (std::size_t k = 0; k < output.distance.size(); ++k) {
        ASSERT_TRUE(std::isnan(output.distance[k]));
        ASSERT_EQ(output.site[k], SiteId::none().value);
      }
    }
  }
}

TEST_F(DeviceField, IndicesOutOfRangeAreRefused) {
  const TriangleMesh mesh = make_box({});
  const GridSpec grid = grid_around(bounds(mesh), 8);
  for (const std::int64_t wrong : {std::int64_t{-1}, std::int64_t{8}, std::int64_t{1} << 32, std::int64_t{1} << 40}) {
    Arrays<double, std::int64_t> arrays(mesh);
    DeviceFieldSolver solver(grid);
    solver.set_connectivity(arrays.view());
    arrays.triangles[5] = wrong;
    EXPECT_THROW(solver.set_connectivity(arrays.view()), InvalidMesh) << wrong;
    // The earlier connectivity is gone.
    Output output(grid);
    EXPECT_THROW(solver.compute(arrays.view().vertices, output.view()), InvalidOption);
  }
}

TEST_F(DeviceField, WrongArgumentsAreRejected) {
  const TriangleMesh mesh = make_box({});
  const GridSpec grid = grid_around(bounds(mesh), 8);
  const Arrays<double, std::int32_t> arrays(mesh);
  Output output(grid);
  EXPECT_THROW(DeviceFieldSolver(grid, {.sign = SignMode::normals}), InvalidOption);
  EXPECT_THROW(DeviceFieldSolver(grid, {.band = -1}), InvalidOption);
  EXPECT_THROW(DeviceFieldSolver(grid, {.site_ids = SiteIds::voxels}), InvalidOption);
  EXPECT_THROW(DeviceFieldSolver(grid, {}, {.device = Device::cpu()}), InvalidOption);
  EXPECT_THROW(DeviceFieldSolver(grid, {}, {.device = Device::cuda(1)}), DeviceError);
  EXPECT_THROW(DeviceFieldSolver(GridSpec{.size = {0, 1, 1}}), InvalidGrid);

  DeviceFieldSolver solver(grid, {.sign = SignMode::winding, .site_ids = SiteIds::triangles});
  EXPECT_THROW(solver.compute(arrays.view().vertices, output.view()), InvalidOption);
  DeviceMeshView view = arrays.view();
  view.triangles.type = ElementType::float32;
  EXPECT_THROW(solver.set_connectivity(view), InvalidOption);
  view = arrays.view();
  view.vertices.type = ElementType::int32;
  EXPECT_THROW(solver.set_connectivity(view), InvalidOption);
  view = arrays.view();
  view.triangles.data = nullptr;
  EXPECT_THROW(solver.set_connectivity(view), InvalidOption);
  view = arrays.view();
  view.triangles.rows = std::size_t{1} << 30;
  EXPECT_THROW(solver.set_connectivity(view), InvalidMesh);
  view.triangles.rows = std::numeric_limits<std::size_t>::max() / 2;
  EXPECT_THROW(solver.set_connectivity(view), InvalidMesh);
  view.triangles.rows = 0;
  EXPECT_THROW(solver.set_connectivity(view), InvalidMesh);
  view = arrays.view();
  view.points = {arrays.triangles.data(), ElementType::int32, 1};
  EXPECT_THROW(solver.set_connectivity(view), InvalidOption);

  solver.set_connectivity(arrays.view());
  EXPECT_THROW(solver.compute(arrays.view().vertices, {nullptr, output.site.data()}), InvalidOption);
  EXPECT_THROW(solver.compute(arrays.view().vertices, {output.distance.data(), nullptr}), InvalidOption);
  EXPECT_THROW(solver.compute({nullptr, ElementType::float64, 8}, output.view()), InvalidOption);
  EXPECT_THROW(solver.compute({arrays.vertices.data(), ElementType::int64, 8}, output.view()), InvalidOption);
}

TEST_F(DeviceField, MemoryEndsWithItsOwner) {
  const DeviceMemory memory(Device::cuda(), 4096);
  EXPECT_NE(memory.data(), nullptr);
  EXPECT_EQ(memory.size(), 4096U);
  EXPECT_THROW(DeviceMemory(Device::cuda(3), 8), DeviceError);
  EXPECT_THROW(DeviceMemory(Device::cpu(), 8), InvalidOption);
}

}  // namespace
}  // namespace blum
