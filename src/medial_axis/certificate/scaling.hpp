// Blum: solids of extreme sizes, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdlib>
#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/medial_axis/medial_complex.hpp"

namespace blum::verifier {

/// Solids of any size are looked at as if they were about 1 large, for the fourth powers of lengths to be numbers. The
/// factor is a power of two, which changes no digit, and 1 unless the size is extreme.
inline double factor_for(double size) {
  constexpr int extreme = 100;
  const int exponent = size > 0 && std::isfinite(size) ? std::ilogb(size) : 0;
  return std::abs(exponent) < extreme ? 1 : std::ldexp(1.0, -exponent);
}

inline MedialComplex scaled(MedialComplex axis, double factor) {
  for (MedialVertex& vertex : axis.vertices) {
    vertex.position *= factor;
    vertex.radius *= factor;
    for (Vec3d& foot : vertex.footprints) foot *= factor;
  }
  return axis;
}

/// A mesh and its vertices, which are its own.
struct ScaledMesh {
  std::vector<Vec3d> vertices;
  MeshView view;

  ScaledMesh(const MeshView& mesh, double factor) : vertices(mesh.vertices.begin(), mesh.vertices.end()), view(mesh) {
    for (Vec3d& v : vertices) v *= factor;
    view.vertices = vertices;
  }
};

}  // namespace blum::verifier
