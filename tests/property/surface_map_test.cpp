// Proves that surface maps keep their errors at 100,000 random points of every generated shape and of real meshes. Maps
// are read at the nearest texel and bilinearly, signed and unsigned. The errors also hold after target and other mesh
// were deformed.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/io/mesh_io.hpp"
#include "blum/points/sample_surface.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "blum/surface_map/surface_distance_map.hpp"
#include "support/data.hpp"
#include "support/map_reading.hpp"
#include "support/mesh_places.hpp"
#include "support/shape_names.hpp"

namespace blum {
namespace {

constexpr std::size_t samples_per_shape = 100'000;

/// Returns vertices after a smooth random motion by up to a part of the mesh's size: a sum of waves.
std::vector<Vec3d> deformed(const MeshView& mesh, double part, std::uint64_t seed) {
  struct Wave {
    Vec3d direction, turns;
    double phase = 0;
  };
  Random random(seed);
  const Box3 box = bounds(mesh);
  const double size = box.diagonal();
  std::array<Wave, 5> waves;
  for (Wave& wave : waves) {
    wave = {random.in_ball() * (part * size / 5), random.in_ball() * (20 / size), random.uniform(0, 6.28)};
  }
  std::vector<Vec3d> out(mesh.vertices.begin(), mesh.vertices.end());
  for (Vec3d& p : out) {
    Vec3d moved = p;
    for (const Wave& wave : waves) moved += wave.direction * std::sin(dot(wave.turns, p - box.lower) + wave.phase);
    p = moved;
  }
  return out;
}

/// Rotates a mesh, and moves and scales it to the middle and size of another mesh.
TriangleMesh fitted(TriangleMesh mesh, const MeshView& to) {
  mesh = test::turned(std::move(mesh));
  const Box3 from = bounds(mesh);
  const Box3 goal = bounds(to);
  const double scale = 0.8 * goal.diagonal() / from.diagonal();
  for (Vec3d& v : mesh.vertices) v = (v - from.center()) * scale + goal.center();
  return mesh;
}

void expect_errors_hold(const SurfaceMap& map, const MeshView& target, const MeshView& other, SignMode sign,
                        std::uint64_t seed) {
  const SurfaceSamples samples = sample_surface(target, samples_per_shape, {.seed = seed});
  const ClosestPointQuery query(other, {sign, {}});
  const std::vector<ClosestPoint> exact = query.nearest(samples.points);
  std::size_t wrong = 0;
  double largest_part = 0;
  for (std::size_t k = 0; k < samples.points.size(); ++k) {
    const std::uint32_t t = samples.triangles[k].value;
    const TexturePlace at = test::place_of(target, *map.atlas, t, samples.points[k]);
    for (const double read : {test::read_nearest(map, at), test::read_bilinear(map, at)}) {
      const double error = std::abs(read - exact[k].distance);
      largest_part = std::max(largest_part, error / map.error[t]);
      if (error <= map.error[t]) continue;
      if (++wrong <= 3) ADD_FAILURE() << "triangle " << t << ": off by " << error << ", said " << map.error[t];
    }
  }
  EXPECT_EQ(wrong, 0U);
  // Loose bounds would prove nothing. If signs may jump, bounds are large.
  if (!query.sign_may_jump()) {
    EXPECT_GT(largest_part, 0.2);
  }
}

void expect_errors_hold(TriangleMesh target, TriangleMesh other, std::uint64_t seed) {
  for (const SignMode sign : {SignMode::none, SignMode::automatic}) {
    SCOPED_TRACE(sign == SignMode::none ? "unsigned" : "signed");
    SurfaceMapper mapper(target, surface_atlas_of_size(target, 100'000), other, {.sign = sign});
    expect_errors_hold(mapper.map(), target, other, sign, seed);
    TriangleMesh moved_target = target;
    moved_target.vertices = deformed(target, 0.2, seed + 1);
    TriangleMesh moved_other = other;
    moved_other.vertices = deformed(other, 0.2, seed + 2);
    mapper.move_target(moved_target.vertices);
    mapper.move_other(moved_other.vertices);
    expect_errors_hold(mapper.map(), moved_target, moved_other, sign, seed + 3);
  }
}

class SurfaceMapOfShapes : public testing::TestWithParam<std::string> {};

TEST_P(SurfaceMapOfShapes, KeepsItsErrors) {
  const TriangleMesh target = make_shape(GetParam());
  if (target.triangles.empty()) GTEST_SKIP() << "no triangles";
  expect_errors_hold(target, fitted(make_shape("torus"), target), 1);
}

TEST_P(SurfaceMapOfShapes, KeepsItsErrorsAsTheOtherMesh) {
  const TriangleMesh shape = make_shape(GetParam());
  const TriangleMesh target = make_organic({.frequency = 6});
  expect_errors_hold(target, fitted(shape, target), 2);
}

INSTANTIATE_TEST_SUITE_P(Shapes, SurfaceMapOfShapes, testing::ValuesIn(test::catalog_names()),
                         [](const auto& info) { return test::test_name(info.param); });

TEST(SlowSurfaceMap, KeepsItsErrorsOnRealMeshes) {
  const auto partner = test::data_file("meshes/spot.obj");
  if (!partner) GTEST_SKIP() << test::no_data("spot.obj");
  const TriangleMesh spot = read_mesh(*partner);
  for (const char* name :
       {"3holes.off", "7_8ths_cube.stl", "abc5.stl", "abc7.stl", "abc9.stl", "ballcube.off", "eight.off", "fandisk.obj",
        "featuretype.STL", "multibody.stl", "not_convex.obj", "plate_holes.STL", "rocker-arm.obj", "round.stl",
        "screwdriver.off", "soup.stl", "spot.obj", "stanford-bunny.obj", "torus.STL"}) {
    SCOPED_TRACE(name);
    const auto file = test::data_file(std::string("meshes/") + name);
    if (!file) GTEST_SKIP() << test::no_data(name);
    const TriangleMesh mesh = read_mesh(*file);
    expect_errors_hold(mesh, fitted(spot, mesh), 3);
    expect_errors_hold(spot, fitted(mesh, spot), 4);
  }
}

}  // namespace
}  // namespace blum
