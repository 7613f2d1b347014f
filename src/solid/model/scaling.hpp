// Blum: coordinates for which predicates are exact. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>

#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// The power of two that brings the largest coordinate of a box to between 1/2 and 1.
[[nodiscard]] int scale_of(const Box3& box);

/// @param exponent  of the power of two to multiply by.
[[nodiscard]] inline Vec3d scaled(const Vec3d& p, int exponent) {
  return {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
}

/// @throws InvalidMesh where a coordinate becomes too small for exact predicates.
[[nodiscard]] TriangleMesh scaled(TriangleMesh mesh, int exponent);

}  // namespace blum::detail
