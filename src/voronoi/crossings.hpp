// Blum: triangles that cross each other, exactly. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "blum/core/vec3.hpp"

namespace blum::voronoi {

/// Whether a segment meets a triangle and does not lie in its plane: by exact signs.
[[nodiscard]] bool crosses(const std::array<Vec3d, 2>& segment, const std::array<Vec3d, 3>& triangle);

/// Whether a side of one triangle crosses the other one.
[[nodiscard]] bool cross_each_other(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b);

}  // namespace blum::voronoi
