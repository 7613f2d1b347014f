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

/// Returns the factor that scales a solid of extreme size to about 1, so that fourth powers of lengths stay finite. For
/// other solids it is 1. The factor is a power of two, so scaling is exact.
inline double factor_for(double size) {
  constexpr int extreme = 100;
  const int exponent = size > 0 && std::isfinite(size) ? std::ilogb(size) : 0;
  return std::abs(exponent) < extreme ? 1 : std::ldexp(1.0, -exponent);
}

/// Returns a medial axis with all lengths multiplied by `factor`.
inline Complex scaled(Complex axis, double factor) {
  for (Vec3d& position : axis.positions) position *= factor;
  for (double& radius : axis.vertex_columns.edit<double>(medial_columns::radius)) radius *= factor;
  for (const std::string_view name : medial_columns::footprints) {
    for (double& coordinate : axis.vertex_columns.edit<double>(name, 3)) coordinate *= factor;
  }
  return axis;
}

/// A scaled mesh that owns its vertices.
struct ScaledMesh {
  std::vector<Vec3d> vertices;
  MeshView view;

  ScaledMesh(const MeshView& mesh, double factor) : vertices(mesh.vertices.begin(), mesh.vertices.end()), view(mesh) {
    for (Vec3d& v : vertices) v *= factor;
    view.vertices = vertices;
  }
};

}  // namespace blum::verifier
