// Proves that the vertices of an axis lie in the solid, are equidistant to two walls and stay near their corners. Their
// radius is the exact distance to the surface.
#include "medial_axis/shape/place_vertices.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "blum/field/reference.hpp"
#include "blum/grid/image_generators.hpp"
#include "blum/grid/selected_voxels.hpp"
#include "blum/shapes/generators.hpp"
#include "medial_axis/cells/voxelize.hpp"
#include "medial_axis/shape/axis_piece.hpp"
#include "medial_axis/surface/mesh_surface.hpp"
#include "medial_axis/surface/voxel_surface.hpp"
#include "support/mesh_places.hpp"
#include "support/voxel_sets.hpp"

namespace blum {
namespace {

using detail::angle_at;
using detail::append_at;
using detail::AxisCell;
using detail::AxisLists;
using detail::AxisPiece;
using detail::AxisVertex;
using detail::GovernorField;
using detail::make_axis_piece;
using detail::MeshSurface;
using detail::place_vertices;
using detail::voxelize_body;
using detail::voxelize_image;
using detail::VoxelSolid;
using detail::VoxelSurface;
using detail::Witnesses;

SolidBody first_body(const TriangleMesh& mesh) {
  const Solid solid = Solid::of(mesh);
  return solid.bodies().front();
}

struct Sample {
  Sample(const TriangleMesh& input, double spacing)
      : mesh(first_body(input)),
        sites(mesh.mesh),
        surface(mesh.mesh, sites, true, {}),
        solid(voxelize_body(mesh, spacing, {}).solid),
        piece(make_axis_piece(GovernorField(solid, surface), {}, 180, phases, {})) {
    for (const AxisCell& cell : piece.cells) {
      if (cell.dimension == 0) cells.push_back(cell.cell);
    }
  }

  [[nodiscard]] bool is_extra(std::size_t vertex) const {
    return vertex >= cells.size() || piece.structure.is_extra(cells[vertex]);
  }
  [[nodiscard]] Vec3d corner(std::size_t vertex) const {
    const auto [i, j, k] = piece.structure.lattice().place(node_of(cells[vertex]));
    return solid.grid.position(i, j, k) - solid.grid.spacing * 0.5;
  }

  SolidBody mesh;
  SiteTable sites;
  MeshSurface surface;
  VoxelSolid solid;
  std::vector<PhaseTime> phases;
  AxisPiece piece;
  std::vector<Cell> cells;  ///< of its vertices
};

/// Distances to the walls of a box around the origin, in ascending order. They are negative outside.
std::array<double, 6> distances_to_walls(const Vec3d& half, const Vec3d& at) {
  std::array<double, 6> distance{};
  for (std::size_t a = 0; a < 3; ++a) {
    distance[2 * a] = half[a] - at[a];
    distance[2 * a + 1] = half[a] + at[a];
  }
  std::sort(distance.begin(), distance.end());
  return distance;
}

/// No point of the axis is near enough to a corner beyond a wall. The centre of a voxel represents such a corner.
TEST(PlaceVertices, VerticesOfABoxLieOnItsBisectors) {
  const Vec3d half{0.5, 0.35, 0.25};
  const double h = 0.043;
  const Sample s(make_box({.size = half * 2.0}), h);
  std::size_t inside = 0;
  for (std::size_t n = 0; n < s.piece.vertices.size(); ++n) {
    const AxisVertex& v = s.piece.vertices[n];
    const std::array<double, 6> distance = distances_to_walls(half, v.position);
    ASSERT_GE(distance[0], 0) << "outside";
    ASSERT_NEAR(v.radius, distance[0], 1e-12);
    if (s.is_extra(n) || distances_to_walls(half, s.corner(n))[0] <= 0) continue;
    ++inside;
    ASSERT_NEAR(distance[1], distance[0], 1e-8 * h) << "on no bisector";
    ASSERT_GT(v.separation_angle, 89.99);
  }
  EXPECT_GT(inside, 9 * s.piece.vertices.size() / 10);
}

TEST(PlaceVertices, RadiiAndFootprintsAreExact) {
  for (const TriangleMesh& mesh : {make_torus({.ring_segments = 20, .tube_segments = 10}), make_wedge({.angle = 20}),
                                   make_cylinder({.sides = 12}), make_void_cube({.segments = 1, .frequency = 2})}) {
    const Sample s(mesh, 0.06);
    const reference::BruteForce brute(s.mesh.mesh);
    for (const AxisVertex& v : s.piece.vertices) {
      const double distance = brute.nearest(v.position).distance;
      ASSERT_NEAR(v.radius, distance, 1e-12);
      for (std::size_t f = 0; f < 2; ++f) {
        ASSERT_NEAR(length(v.position - v.footprints[f]), distance, 1e-7 * 0.06);
        ASSERT_LE(brute.nearest(v.footprints[f]).distance, 1e-12);
        ASSERT_LE(brute.site_distance(v.sites[f], v.footprints[f]), 1e-12);
      }
      ASSERT_NEAR(v.separation_angle, angle_at(v.position, v.footprints[0], v.footprints[1]), 1e-9);
      ASSERT_TRUE(distance < 1e-9 || reference::winding_number(s.mesh.mesh, v.position) > 0.5) << "outside";
    }
  }
}

TEST(PlaceVertices, VerticesStayNearTheirCorners) {
  const Sample s(make_torus({.ring_segments = 20, .tube_segments = 10}), 0.06);
  for (std::size_t n = 0; n < s.piece.vertices.size(); ++n) {
    if (s.is_extra(n)) continue;
    const Vec3d moved = s.piece.vertices[n].position - s.corner(n);
    for (std::size_t a = 0; a < 3; ++a) ASSERT_LE(std::abs(moved[a]), 0.7 * 0.06 + 1e-12);
  }
}

/// The voxels around a corner have only eight of the many facets of a round body as sites. The search finds the others
/// as it proceeds. The axis of a torus is a circle, and few vertices are far from it.
TEST(PlaceVertices, VerticesOfARoundBodyHaveTwoWalls) {
  const double h = 0.04;
  const Sample s(make_torus({.ring_segments = 48, .tube_segments = 24}), h);
  AxisLists circle;
  append_at(s.piece, 60, circle, {});
  ASSERT_GT(circle.vertices.size(), 100U);
  std::vector<double> off;
  std::size_t one_wall = 0;
  for (const AxisVertex& v : circle.vertices) {
    off.push_back(std::hypot(std::hypot(v.position.x, v.position.y) - 1, v.position.z));
    one_wall += v.separation_angle > 0 ? 0 : 1;
  }
  EXPECT_LT(one_wall, circle.vertices.size() / 20);
  std::nth_element(off.begin(), off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2), off.end());
  EXPECT_LT(off[off.size() / 2], 0.15 * h);
}

/// The reference is a search over all closed voxels that are not selected.
TEST(PlaceVertices, RadiiOfImagesAreDistancesToVoxelFaces) {
  VoxelImage image = make_tube_image({.nodes = 2, .pitch = 10, .radius = 2.5, .spacing = {1, 1.25, 0.8}});
  image.grid.direction = test::turned_grid(image.grid.size).direction;
  std::array<std::int64_t, 3> first{};
  const VoxelSolid solid = voxelize_image(selected_voxels(image, {}), image.grid, first, {}).solid;
  const VoxelSurface surface(solid.voxels, solid.grid);
  std::vector<PhaseTime> phases;
  const AxisPiece piece = make_axis_piece(GovernorField(solid, surface), {20, 120, 3, 0}, 180, phases, {});
  ASSERT_GT(piece.vertices.size(), 50U);
  for (const AxisVertex& v : piece.vertices) {
    double least = 1e9;
    test::for_each_voxel(solid.grid.size, 0, [&](auto i, auto j, auto k) {
      const Vec3d from = solid.grid.direction.transposed_times(v.position - solid.grid.position(i, j, k));
      Vec3d beyond;
      for (std::size_t a = 0; a < 3; ++a) {
        beyond[a] = std::max(0.0, std::abs(from[a]) - 0.5 * solid.grid.spacing[a]);
      }
      if (!solid.voxels.contains(i, j, k)) least = std::min(least, length(beyond));
    });
    ASSERT_NEAR(v.radius, least, 1e-12);
    ASSERT_NEAR(length(v.position - v.footprints[0]), least, 1e-12);
    ASSERT_NEAR(length(v.position - v.footprints[1]), least, 2e-6);
  }
}

TEST(PlaceVertices, ThreadsDoNotMatter) {
  const Sample s(make_wedge({.angle = 40}), 0.05);
  const GovernorField governors(s.solid, s.surface);
  for (const int threads : {1, 2, 7}) {
    const Context context{.threads = threads};
    const auto vertices = place_vertices(Witnesses(governors, s.piece.structure), s.cells, context);
    ASSERT_LE(vertices.size(), s.piece.vertices.size());
    for (std::size_t n = 0; n < vertices.size(); ++n) {
      ASSERT_EQ(vertices[n].position, s.piece.vertices[n].position);
      ASSERT_EQ(vertices[n].radius, s.piece.vertices[n].radius);
      ASSERT_EQ(vertices[n].footprints, s.piece.vertices[n].footprints);
    }
  }
}

}  // namespace
}  // namespace blum
