// Blum: whether triangles, segments and points meet, exactly. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "blum/core/vec3.hpp"

namespace blum::detail {

/// Whether two triangles, which may be segments or points, have a point in common. Exact for coordinates of magnitude
/// 1e-80 to 1e100, or 0.
[[nodiscard]] bool meet(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b);

}  // namespace blum::detail
