// Blum: the cone of directions that point away from all edges of a vertex. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/vec3.hpp"

namespace blum::voronoi {

/// Returns true if three points lie on one line. Uses exact signs.
[[nodiscard]] bool are_collinear(const Vec3d& a, const Vec3d& b, const Vec3d& c);

/// Returns the constraints that bound the dual cone of edges v - w_i, in the order around it. The cone contains the
/// directions x with x . (w_i - v) <= 0 for all i. Returns none if the cone has no interior. Exact. The result may
/// include constraints that touch the cone in a ray.
/// @param ends  the w_i, not v itself; no two in the same direction from it.
/// Cost: O(n m) for n edges of which m bound the cone.
[[nodiscard]] std::vector<std::uint32_t> dual_cone(const Vec3d& v, std::span<const Vec3d> ends);

}  // namespace blum::voronoi
