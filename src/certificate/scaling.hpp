// Blum: solids of extreme sizes, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/complex/medial_columns.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::verifier {

/// Solids of any size are looked at as if they were about 1 large, for the fourth powers of lengths to be numbers. The
/// factor is a power of two, which changes no digit, and 1 unless the size is extreme.
inline double factor_for(double size) {
  constexpr int extreme = 100;
  const int exponent = size > 0 && std::isfinite(size) ? std::ilogb(size) : 0;
  return std::abs(exponent) < extreme ? 1 : std::ldexp(1.0, -exponent);
}

/// A medial axis, all of whose lengths are `factor` times as large.
inline Complex scaled(Complex axis, double factor) {
  for (Vec3d& position : axis.positions) position *= factor;
  for (double& radius : axis.vertex_columns.edit<double>(medial_columns::radius)) radius *= factor;
  for (const std::string_view name : medial_columns::footprints) {
    for (double& coordinate : axis.vertex_columns.edit<double>(name, 3)) coordinate *= factor;
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
