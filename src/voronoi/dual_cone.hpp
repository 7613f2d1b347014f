// Blum: the cone of directions that point away from all edges of a vertex. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/vec3.hpp"

namespace blum::voronoi {

/// Returns true if three points lie on a line. Uses exact signs.
[[nodiscard]] bool are_collinear(const Vec3d& a, const Vec3d& b, const Vec3d& c);

/// Returns the indices i of the constraints that bound the dual cone of edges v - w_i, in the order around the cone.
/// The cone contains the directions x with x . (w_i - v) <= 0 for all i. Returns an empty list if the cone has no
/// interior. Uses exact signs. The result may include constraints whose planes touch the cone only in a ray.
/// @param ends  the points w_i. None equals v, and no two lie in the same direction from v.
/// Cost: O(n m) for n edges of which m bound the cone.
[[nodiscard]] std::vector<std::uint32_t> dual_cone(const Vec3d& v, std::span<const Vec3d> ends);

}  // namespace blum::voronoi
