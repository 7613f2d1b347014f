// Blum: the point that is as far from some points as from the others. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "blum/core/vec3.hpp"

namespace blum {

/// The point near `start` whose distances from the given points differ least, moved only along the directions in which
/// these points say anything: the `rank` strongest ones.
/// @param rank  1, 2 or 3.
/// @return      nullopt where the points say less (all but one direction weaker than a tenth of the strongest, say).
[[nodiscard]] std::optional<Vec3d> equidistant_point(std::span<const Vec3d> points, const Vec3d& start, int rank);

}  // namespace blum
