// Blum: the directions that go against all edges of a vertex. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/vec3.hpp"

namespace blum::voronoi {

/// Three points in one line, by exact signs.
[[nodiscard]] bool are_collinear(const Vec3d& a, const Vec3d& b, const Vec3d& c);

/// The constraints of the dual cone of edges v - w_i, the directions x with x . (w_i - v) <= 0 for all i, that bound
/// it, in the order around it; none where it has no interior. Exact. Constraints that touch it in a ray may be among
/// them.
/// @param ends  the w_i, not v itself; no two in the same direction from it.
/// Cost: O(n m) for n edges of which m bound the cone.
[[nodiscard]] std::vector<std::uint32_t> dual_cone(const Vec3d& v, std::span<const Vec3d> ends);

}  // namespace blum::voronoi
