// Blum: shapes, poses and slow distances for tests of motions. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "blum/core/vec3.hpp"
#include "blum/geometry/rigid_transform.hpp"
#include "blum/geometry/triangle_distance.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/shapes/generators.hpp"

namespace blum::test {

inline TriangleMesh box(const Vec3d& size, const Vec3d& centre = {}) {
  TriangleMesh out = make_box({.size = size});
  for (Vec3d& v : out.vertices) v += centre;
  return out;
}

inline RigidTransform moved(const Vec3d& translation) {
  RigidTransform out;
  out.translation = translation;
  return out;
}

inline RigidTransform turned_z(double angle, const Vec3d& translation = {}) {
  RigidTransform out;
  out.rotation.columns[0] = {std::cos(angle), std::sin(angle), 0};
  out.rotation.columns[1] = {-std::sin(angle), std::cos(angle), 0};
  out.translation = translation;
  return out;
}

/// Returns the distance of two surfaces at two poses, by comparing all pairs of triangles.
inline double slow_distance(const TriangleMesh& first, const RigidTransform& at_first, const TriangleMesh& second,
                            const RigidTransform& at_second = {}) {
  double least = std::numeric_limits<double>::infinity();
  const auto corners = [](const TriangleMesh& mesh, const Triangle& t, const RigidTransform& at) {
    return std::array{at(mesh.vertices[t[0]]), at(mesh.vertices[t[1]]), at(mesh.vertices[t[2]])};
  };
  for (const Triangle& a : first.triangles) {
    for (const Triangle& b : second.triangles) {
      least = std::min(least, triangle_distance(corners(first, a, at_first), corners(second, b, at_second)).distance);
    }
  }
  return least;
}

}  // namespace blum::test
