// Proves that zero_surface() gives closed, oriented manifolds that face outwards and have the topology of the shape.
// The tests cover smooth, random and degenerate fields and grids of any direction. They bound the positions of
// vertices. The bytes are the same for any number of threads.
#include "blum/field/zero_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>
#include <set>
#include <stop_token>

#include "blum/core/random.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/shapes/generators.hpp"

namespace blum {
namespace {

using Betti = std::array<std::int64_t, 3>;
using Size = std::array<std::int64_t, 3>;

Field field_of(const GridSpec& grid, const std::function<double(const Vec3d&)>& distance) {
  Field field;
  field.grid = grid;
  field.distance = Buffer<float>(grid.node_count());
  for (std::int64_t k = 0; k < grid.size[2]; ++k) {
    for (std::int64_t j = 0; j < grid.size[1]; ++j) {
      for (std::int64_t i = 0; i < grid.size[0]; ++i) {
        field.distance[grid.index(i, j, k)] = static_cast<float>(distance(grid.position(i, j, k)));
      }
    }
  }
  return field;
}

/// Returns a grid around the origin.
GridSpec centred_grid(const Size& size, const Vec3d& spacing, const Mat3& direction = {}) {
  GridSpec grid;
  grid.size = size;
  grid.spacing = spacing;
  grid.direction = direction;
  const auto half = [&](std::size_t axis) { return 0.5 * static_cast<double>(size[axis] - 1) * spacing[axis]; };
  grid.origin = -(direction * Vec3d{half(0), half(1), half(2)});
  return grid;
}

GridSpec cube_grid(std::int64_t nodes, double side = 3) {
  const double spacing = side / static_cast<double>(nodes - 1);
  return centred_grid({nodes, nodes, nodes}, {spacing, spacing, spacing});
}

double sphere(const Vec3d& p) {
  return length(p) - 1;
}

double torus(const Vec3d& p) {
  return std::hypot(std::hypot(p.x, p.y) - 0.9, p.z) - 0.3;
}

/// Returns a rotation about a skew axis, mirrored on request.
Mat3 skew_direction(bool is_mirrored) {
  const Vec3d a = Vec3d{1, 2, -0.5} / length(Vec3d{1, 2, -0.5});
  const Vec3d other = cross(a, {0.3, -0.2, 1});
  const Vec3d b = other / length(other);
  const Vec3d c = cross(a, b);
  return {{a, b, is_mirrored ? -c : c}};
}

/// Returns random distances. Border nodes are outside unless `is_open`.
Field random_field(const Size& size, std::uint64_t seed, bool is_open, const std::function<double(Random&)>& draw) {
  Random random(seed);
  Field field;
  field.grid = centred_grid(size, {1, 1, 1});
  field.distance = Buffer<float>(field.grid.node_count());
  for (std::int64_t k = 0; k < size[2]; ++k) {
    for (std::int64_t j = 0; j < size[1]; ++j) {
      for (std::int64_t i = 0; i < size[0]; ++i) {
        const bool is_border = i % (size[0] - 1) == 0 || j % (size[1] - 1) == 0 || k % (size[2] - 1) == 0;
        const double value = draw(random);
        field.distance[field.grid.index(i, j, k)] = static_cast<float>(is_border && !is_open ? 1 : value);
      }
    }
  }
  return field;
}

double uniform_value(Random& random) {
  return random.uniform(-1, 1);
}

/// Returns -1, 0 or 1, so most crossed edges have an end of exactly the level.
double whole_value(Random& random) {
  return static_cast<double>(random.below(3)) - 1;
}

void expect_manifold(const Topology& t) {
  EXPECT_TRUE(t.manifold && t.oriented) << t.nonmanifold_edges << ' ' << t.nonmanifold_vertices;
  EXPECT_EQ(t.degenerate_triangles, 0U);
  EXPECT_EQ(t.duplicate_triangles, 0U);
  EXPECT_EQ(t.named_vertices, t.vertices);
}

void expect_solid(const TriangleMesh& mesh, const Betti& betti) {
  const Topology t = topology(mesh);
  expect_manifold(t);
  EXPECT_TRUE(t.closed && t.faces_outwards);
  EXPECT_EQ(t.betti, betti);
}

bool same_bytes(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices.size() == b.vertices.size() && a.triangles == b.triangles &&
         std::memcmp(a.vertices.data(), b.vertices.data(), a.vertices.size() * sizeof(Vec3d)) == 0;
}

TEST(ZeroSurface, OneNodeInside) {
  const Field field = field_of(cube_grid(3, 2), [](const Vec3d& p) { return squared_length(p) > 0 ? 1.0 : -1.0; });
  const TriangleMesh mesh = zero_surface(field);
  EXPECT_EQ(mesh.vertices.size(), 14U);   // a node has 14 edges
  EXPECT_EQ(mesh.triangles.size(), 24U);  // and 24 tetrahedra
  expect_solid(mesh, {1, 0, 0});
}

TEST(ZeroSurface, ShapesKeepTheirTopology) {
  expect_solid(zero_surface(field_of(cube_grid(40), sphere)), {1, 0, 0});
  expect_solid(zero_surface(field_of(cube_grid(60), torus)), {1, 1, 0});
  expect_solid(zero_surface(field_of(cube_grid(40), [](const Vec3d& p) { return std::abs(length(p) - 0.9) - 0.3; })),
               {1, 0, 1});
}

TEST(ZeroSurface, FieldsOfMeshesKeepTheirTopology) {
  for (const TriangleMesh& mesh : {make_box({}), make_torus_knot({}), make_plate({}), make_linked_tori({})}) {
    for (const std::optional<double> band : {std::optional<double>{}, std::optional<double>{0.1}}) {
      const GridSpec grid = grid_around(bounds(mesh), 120);
      const TriangleMesh surface = zero_surface(distance_field(mesh, grid, {.band = band}));
      const Topology expected = topology(mesh);
      ASSERT_TRUE(expected.betti.has_value());
      expect_solid(surface, *expected.betti);
      EXPECT_NEAR(topology(surface).signed_volume, expected.signed_volume, 0.05 * expected.signed_volume);
    }
  }
}

/// Returns the largest distance of a vertex from the sphere of the given radius.
double largest_error(const TriangleMesh& mesh, double radius = 1) {
  double worst = 0;
  for (const Vec3d& v : mesh.vertices) worst = std::max(worst, std::abs(length(v) - radius));
  return worst;
}

TEST(ZeroSurface, VerticesConvergeToASphere) {
  for (const std::int64_t nodes : {16, 31, 61, 121}) {
    const GridSpec grid = cube_grid(nodes);
    const double diagonal = std::sqrt(3.0) * grid.spacing.x;
    // On an edge of length L the distance differs from a linear function by at most L^2 / (8 R).
    const double bound = diagonal * diagonal / (8 * (1 - diagonal)) + 1e-3 * diagonal;
    EXPECT_LE(largest_error(zero_surface(field_of(grid, sphere))), bound) << nodes;
  }
}

TEST(ZeroSurface, OtherLevels) {
  const Field field = field_of(cube_grid(61), sphere);
  for (const double level : {-0.5, 0.123456789, 0.3}) {
    const TriangleMesh mesh = zero_surface(field, level);
    expect_solid(mesh, {1, 0, 0});
    EXPECT_LE(largest_error(mesh, 1 + level), 4e-3) << level;
  }
  EXPECT_TRUE(zero_surface(field, 10).triangles.empty());
  EXPECT_TRUE(zero_surface(field, -10).vertices.empty());
  EXPECT_TRUE(zero_surface(field, 1e300).vertices.empty());
  EXPECT_TRUE(zero_surface(field, -1e300).vertices.empty());
}

TEST(ZeroSurface, AnyDirectionAndSpacing) {
  const double volume = 4.0 / 3 * std::numbers::pi;
  for (const bool is_mirrored : {false, true}) {
    const GridSpec grid = centred_grid({60, 41, 31}, {0.05, 0.07, 0.1}, skew_direction(is_mirrored));
    const TriangleMesh mesh = zero_surface(field_of(grid, sphere));
    expect_solid(mesh, {1, 0, 0});
    EXPECT_LE(largest_error(mesh), 4e-3);
    EXPECT_NEAR(topology(mesh).signed_volume, volume, 0.02 * volume);
  }
}

TEST(ZeroSurface, NoiseIsAManifold) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const auto& draw : {uniform_value, whole_value}) {
      const Topology closed = topology(zero_surface(random_field({11, 9, 13}, seed, false, draw)));
      expect_manifold(closed);
      EXPECT_TRUE(closed.closed && closed.faces_outwards);
      const Topology open = topology(zero_surface(random_field({11, 9, 13}, seed, true, draw)));
      expect_manifold(open);
      EXPECT_FALSE(open.closed);
    }
  }
}

TEST(ZeroSurface, NoiseDoesNotCrossItself) {
  for (const auto& draw : {uniform_value, whole_value}) {
    EXPECT_EQ(find_self_intersections(zero_surface(random_field({9, 9, 9}, 5, true, draw))).crossing, 0U);
  }
}

TEST(ZeroSurface, EveryCubeIsAManifold) {
  for (unsigned corners = 1; corners < 256; ++corners) {
    const GridSpec grid = cube_grid(4);
    Field field = field_of(grid, [](const Vec3d&) { return 1; });
    for (std::int64_t c = 0; c < 8; ++c) {
      if ((corners >> c & 1U) != 0) field.distance[grid.index(1 + (c & 1), 1 + (c >> 1 & 1), 1 + (c >> 2))] = -1;
    }
    const Topology t = topology(zero_surface(field));
    expect_manifold(t);
    EXPECT_TRUE(t.closed && t.faces_outwards) << corners;
  }
}

TEST(ZeroSurface, NodesOfExactlyTheLevelAreOutside) {
  // The faces of this cube run through nodes, so the value is exactly the level on all of them.
  const auto largest = [](const Vec3d& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) - 4; };
  const TriangleMesh mesh = zero_surface(field_of(cube_grid(13, 12), largest));
  expect_solid(mesh, {1, 0, 0});
  std::set<std::array<double, 3>> places;
  for (const Vec3d& v : mesh.vertices) {
    places.insert({v.x, v.y, v.z});
    EXPECT_NEAR(largest(v), -1e-3, 1e-12);  // each vertex keeps this part of its edge away from the end
  }
  EXPECT_EQ(places.size(), mesh.vertices.size());
  // If all nodes have the level, nothing is inside.
  EXPECT_TRUE(zero_surface(field_of(cube_grid(5), [](const Vec3d&) { return 0; })).triangles.empty());
}

TEST(ZeroSurface, IsOpenWhereItLeavesTheGrid) {
  const Topology t = topology(zero_surface(field_of(cube_grid(20, 1.5), sphere)));
  expect_manifold(t);
  EXPECT_FALSE(t.closed);
  EXPECT_GT(t.boundary_edges, 0U);
}

TEST(ZeroSurface, SmallestGrid) {
  const TriangleMesh mesh = zero_surface(field_of(cube_grid(2), [](const Vec3d& p) { return p.z; }));
  const Topology t = topology(mesh);
  expect_manifold(t);
  EXPECT_DOUBLE_EQ(t.area, 9);
  for (const Triangle& corners : mesh.triangles) {
    const Vec3d& a = mesh.vertices[corners[0]];
    EXPECT_GT(cross(mesh.vertices[corners[1]] - a, mesh.vertices[corners[2]] - a).z, 0);
  }
}

TEST(ZeroSurface, SameBytesOnAnyNumberOfThreads) {
  for (const Size& size : {Size{70, 60, 90}, Size{1100, 1000, 11}}) {
    const Field field = random_field(size, 3, true, [](Random& random) { return random.uniform(-0.02, 1); });
    const TriangleMesh one = zero_surface(field, 0, {.threads = 1});
    EXPECT_FALSE(one.triangles.empty());
    for (const int threads : {2, 7}) EXPECT_TRUE(same_bytes(one, zero_surface(field, 0, {.threads = threads})));
  }
}

TEST(ZeroSurface, RejectsInvalidFieldsAndLevels) {
  Field field = field_of(cube_grid(4), sphere);
  EXPECT_THROW((void)zero_surface(field, std::numeric_limits<double>::quiet_NaN()), InvalidOption);
  EXPECT_THROW((void)zero_surface(field, std::numeric_limits<double>::infinity()), InvalidOption);
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
    field.distance[3 + 2 * 4 + 1 * 16] = bad;
    try {
      (void)zero_surface(field);
      FAIL() << bad;
    } catch (const InvalidOption& error) {
      EXPECT_NE(std::string(error.what()).find("(3, 2, 1)"), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW((void)zero_surface(field_of(centred_grid({5, 1, 5}, {1, 1, 1}), sphere)), InvalidGrid);
  EXPECT_THROW((void)zero_surface(Field{}), InvalidGrid);
  field.distance = Buffer<float>(63, 1.0F);
  EXPECT_THROW((void)zero_surface(field), InvalidOption);
}

TEST(ZeroSurface, CanBeCancelled) {
  const Field field = field_of(cube_grid(20), sphere);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)zero_surface(field, 0, {.cancel = stop.get_token()}), Cancelled);
}

TEST(LevelWarnings, OfSurfacesThatLeaveTheGridAndOfShapesOneNodeThick) {
  const TriangleMesh box = make_box({.size = {1, 1, 1}});
  const Field field = distance_field(box, grid_in({{-1, -1, -1}, {1, 1, 1}}, 21));
  EXPECT_TRUE(level_warnings(field).empty());
  const std::vector<Warning> cut = level_warnings(field, 0.6);
  ASSERT_EQ(cut.size(), 1U);
  EXPECT_EQ(cut[0].code, WarningCode::left_out);
  const Field plate = distance_field(make_box({.size = {1, 1, 0.05}}), grid_in({{-1, -1, -1}, {1, 1, 1}}, 21));
  const std::vector<Warning> thin = level_warnings(plate);
  ASSERT_EQ(thin.size(), 1U);
  EXPECT_EQ(thin[0].code, WarningCode::coarse_grid);
  EXPECT_TRUE(thin[0].text.starts_with("the shape is one node thick at ")) << thin[0].text;
  EXPECT_TRUE(level_warnings(plate, 0.3).empty());
}

}  // namespace
}  // namespace blum
