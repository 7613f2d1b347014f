// Blum: directions to the last bits. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/vec3.hpp"

namespace blum::voronoi {

/// A vector of length 1 in the direction of one that is not 0, of any length.
[[nodiscard]] Vec3d unit(const Vec3d& v);

/// The direction of (b - a) x (c - a), also of triangles that are nearly lines.
[[nodiscard]] Vec3d unit_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c);

}  // namespace blum::voronoi
