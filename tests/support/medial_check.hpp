// Blum: checks of medial axes for tests. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "blum/certificate/certificate.hpp"
#include "blum/field/closest_points.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "support/shape_names.hpp"

namespace blum::test {

/// Angles from the full axis to almost none of it. Many sheets have an angle of 90 degrees.
inline constexpr std::array<double, 6> angles{0, 20, 60, 90, 120, 170};

/// Betti numbers of a complex, without changes to it.
inline BettiNumbers betti_of(const Complex& complex) {
  return homology(complex.view());
}

/// Checks the Betti numbers at every angle.
inline void expect_betti(const MedialAxis& axis, const BettiNumbers& betti) {
  for (const double theta : angles) EXPECT_EQ(betti_of(axis.simplify(theta)), betti) << "theta " << theta;
}

/// Checks that certificates hold at the smallest angle, whose axis contains all others, and at the largest angle, body
/// by body.
inline void expect_certificates(const MedialAxis& axis, const MeshView& mesh, double least_theta = 0) {
  for (const double theta : {least_theta, angles.back()}) {
    const Certificate certificate = certify(axis.simplify(theta), mesh, {.balls = false});
    for (const std::string& mismatch : certificate.mismatches) ADD_FAILURE() << "theta " << theta << ": " << mismatch;
  }
}

/// Checks that the mesh was treated as a polyhedron, and that its axis is certified.
inline void expect_certified(const MedialAxis& axis, const MeshView& mesh, const BettiNumbers& betti) {
  EXPECT_EQ(axis.report().rule, SolidRule::polyhedron) << axis.report().reason;
  EXPECT_TRUE(axis.report().topology_matches);
  EXPECT_EQ(axis.report().betti, betti);
  expect_betti(axis, betti);
  expect_certificates(axis, mesh);
}

/// A complex as a mesh, for distance queries. Vertices keep their order.
inline TriangleMesh shape_of(const Complex& complex) {
  TriangleMesh mesh;
  mesh.vertices = complex.positions;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) mesh.points.push_back(v);
  mesh.segments = complex.edges;
  mesh.triangles = complex.triangles;
  return mesh;
}

inline std::vector<Vec3d> positions(const Complex& complex) {
  return complex.positions;
}

/// The largest distance of the points from a shape.
inline double furthest_from(const MeshView& shape, std::span<const Vec3d> points) {
  double furthest = 0;
  for (const ClosestPoint& at : closest_points(shape, points, {.sign = SignMode::none})) {
    furthest = std::max(furthest, at.distance);
  }
  return furthest;
}

/// The diagonal of the largest voxel of any body.
inline double voxel_diagonal(const MedialAxis& axis) {
  double spacing = 0;
  for (const BodyReport& body : axis.report().bodies) spacing = std::max(spacing, body.spacing);
  return std::sqrt(3.0) * spacing;
}

/// Checks that footprints lie on the surface, at the surface's distance from their vertex, within 1e-6 of the diagonal.
inline void expect_exact_balls(const Complex& complex, const MeshView& mesh) {
  const double tolerance = 1e-6 * bounds(mesh).diagonal();
  const MedialView axis(complex);
  const ClosestPointQuery surface(mesh, {.sign = SignMode::none});
  double radius_error = 0;
  double off_surface = 0;
  double footprint_error = 0;
  for (std::size_t v = 0; v < axis.positions.size(); ++v) {
    const double radius = surface.nearest(axis.positions[v]).distance;
    radius_error = std::max(radius_error, std::abs(axis.radius[v] - radius));
    for (const Vec3d& foot : {axis.footprint(v, 0), axis.footprint(v, 1)}) {
      off_surface = std::max(off_surface, surface.nearest(foot).distance);
      footprint_error = std::max(footprint_error, std::abs(length(foot - axis.positions[v]) - radius));
    }
  }
  EXPECT_LE(radius_error, tolerance);
  EXPECT_LE(off_surface, tolerance);
  EXPECT_LE(footprint_error, tolerance);
}

/// The rotation matrix for an angle, in degrees, around an axis.
inline Mat3 rotation(const Vec3d& axis, double degrees) {
  const Vec3d u = axis / length(axis);
  const double radians = degrees * 3.14159265358979323846 / 180;
  Mat3 turn;
  for (Vec3d& column : turn.columns) {
    column = column * std::cos(radians) + cross(u, column) * std::sin(radians) +
             u * (dot(u, column) * (1 - std::cos(radians)));
  }
  return turn;
}

inline TriangleMesh turned(TriangleMesh mesh, const Mat3& turn) {
  for (Vec3d& v : mesh.vertices) v = turn * v;
  return mesh;
}

}  // namespace blum::test
