// Proves that an edge across a gap of any width is rejected. Edges that leave the solid beside a reflex edge, or run
// along the surface, are accepted.
#include <gtest/gtest.h>

#include <array>
#include <utility>
#include <vector>

#include "blum/certificate/certificate.hpp"
#include "blum/shapes/generators.hpp"
#include "certificate/segments.hpp"

namespace blum {
namespace {

constexpr double slit_end = 0.25;

/// A unit cube with a slit in its middle, from above down to y = slit_end.
TriangleMesh slit_cube(double width) {
  const double left = 0.5 - width / 2;
  const double right = 0.5 + width / 2;
  TriangleMesh mesh;
  for (const double z : {0.0, 1.0}) {
    for (const auto& [x, y] : {std::pair{0.0, 0.0},
                               {1.0, 0.0},
                               {1.0, 1.0},
                               {right, 1.0},
                               {right, slit_end},
                               {left, slit_end},
                               {left, 1.0},
                               {0.0, 1.0}}) {
      mesh.vertices.push_back({x, y, z});
    }
  }
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (std::uint32_t k = 0; k < 8; ++k) quad(k, (k + 1) % 8, (k + 1) % 8 + 8, k + 8);
  for (const auto& [a, b, c, d] : std::vector<std::array<std::uint32_t, 4>>{{0, 5, 6, 7}, {0, 1, 4, 5}, {1, 2, 3, 4}}) {
    quad(d, c, b, a);
    quad(a + 8, b + 8, c + 8, d + 8);
  }
  return mesh;
}

Certificate of_path(std::vector<Vec3d> path, const TriangleMesh& mesh) {
  Complex complex;
  complex.positions = std::move(path);
  for (std::uint32_t k = 0; k + 1 < complex.positions.size(); ++k) complex.edges.push_back({k, k + 1});
  return certify_topology(complex, mesh);
}

TEST(GapSearch, EdgesAcrossSlitsOfAnyWidth) {
  for (const double width : {1e-2, 1e-4, 3e-5, 1e-6, 1e-9, 1e-12}) {
    const TriangleMesh mesh = slit_cube(width);
    const Certificate across = of_path({{0.3, 0.6, 0.4}, {0.7, 0.7, 0.5}}, mesh);
    EXPECT_TRUE(across.topology_holds);
    EXPECT_FALSE(across.edges.holds) << width;
    EXPECT_EQ(across.edges.outside + across.edges.across, 1U) << width;
    EXPECT_LE(across.homology.proven, Proven::betti_numbers) << width;
    EXPECT_TRUE(of_path({{0.3, 0.6, 0.4}, {0.4, 0.2, 0.4}, {0.6, 0.2, 0.4}, {0.7, 0.7, 0.5}}, mesh).holds()) << width;
  }
}

TEST(GapSearch, AVertexInASlitDoesNotJoinWalls) {
  const double width = 1e-6;
  const Certificate across = of_path({{0.3, 0.6, 0.4}, {0.5, 0.65, 0.45}, {0.7, 0.7, 0.5}}, slit_cube(width));
  EXPECT_EQ(across.edges.outside, 0U) << "none is out by more than is allowed";
  EXPECT_EQ(across.edges.across, 1U) << "one of its edges ends at the other wall";
}

TEST(GapSearch, PastTheEndOfASlit) {
  const TriangleMesh mesh = slit_cube(1e-6);
  const double edges_are_checked_to = of_path({{0.3, 0.1, 0.4}, {0.7, 0.1, 0.5}}, mesh).edges.tolerance;
  for (const double above : {0.0, 1e-12, 1e-9, 1e-6, 0.5 * edges_are_checked_to}) {
    const double y = slit_end + above;
    EXPECT_TRUE(of_path({{0.3, y, 0.4}, {0.7, y, 0.5}}, mesh).holds()) << above;
  }
  EXPECT_FALSE(
      of_path({{0.3, slit_end + 3 * edges_are_checked_to, 0.4}, {0.7, slit_end + 3 * edges_are_checked_to, 0.5}}, mesh)
          .holds());
}

TEST(GapSearch, AlongTheSurface) {
  const TriangleMesh mesh = slit_cube(1e-6);
  const double left = mesh.vertices[5].x;
  EXPECT_TRUE(of_path({{left, slit_end, 0}, {left, slit_end, 1}, {left, 1, 1}, {0, 1, 1}, {0, 1, 0}}, mesh).holds());
  EXPECT_TRUE(of_path({{left, 0.5, 0.2}, {left, 0.9, 0.7}}, mesh).holds()) << "on a wall of the slit";
  EXPECT_TRUE(of_path({{0.2, 0, 0.2}, {0.7, 0, 0.7}}, mesh).holds()) << "along the side of a triangle";
}

/// The path runs along an edge of the mesh, closer than rounding resolves.
TEST(GapSearch, InAThinWall) {
  const TriangleMesh wall = make_box({.size = {1, 1, 1e-10}});
  const Vec3d middle = bounds(wall).center();
  for (const double turn : {1.0, -1.0}) {
    const Vec3d along{0.4, 0.4 * turn, 0};
    const Certificate found = of_path({middle - along, middle + along}, wall);
    EXPECT_TRUE(found.holds());
    EXPECT_EQ(found.edges.undecided, 0U);
    EXPECT_EQ(found.homology.proven, Proven::homotopy_type);
  }
}

TEST(Segments, Distances) {
  using verifier::squared_distance;
  EXPECT_DOUBLE_EQ(squared_distance({{0, 0, 0}, {1, 0, 0}}, {{0.5, 1, -1}, {0.5, 1, 1}}), 1);
  EXPECT_DOUBLE_EQ(squared_distance({{0, 0, 0}, {1, 0, 0}}, {{2, 2, 0}, {3, 2, 0}}), 5);
  EXPECT_DOUBLE_EQ(squared_distance({{0, 0, 0}, {0, 0, 0}}, {{1, 1, 0}, {1, -1, 0}}), 1);
  EXPECT_DOUBLE_EQ(verifier::closest_along({{0, 0, 0}, {4, 0, 0}}, {{1, 1, 0}, {3, 1, 0}}), 0.5) << "side by side";
}

}  // namespace
}  // namespace blum
