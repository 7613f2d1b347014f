// Blum: a double cone for tests and benchmarks, in whose ends many planes meet. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "blum/geometry/triangle_mesh.hpp"

namespace blum::test {

/// Double cone over a regular polygon: its planes meet in two points.
inline TriangleMesh double_cone(std::uint32_t sides) {
  TriangleMesh mesh;
  for (std::uint32_t k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * k / sides;
    mesh.vertices.push_back({std::cos(angle), std::sin(angle), 0});
  }
  mesh.vertices.push_back({0, 0, 1});
  mesh.vertices.push_back({0, 0, -1});
  for (std::uint32_t k = 0; k < sides; ++k) {
    mesh.triangles.push_back({k, (k + 1) % sides, sides});
    mesh.triangles.push_back({(k + 1) % sides, k, sides + 1});
  }
  return mesh;
}

}  // namespace blum::test
