// Blum: points with their closest points, as columns of files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "blum/complex/complex.hpp"
#include "blum/core/vec3.hpp"
#include "blum/field/closest_points.hpp"

namespace blum::cli {

/// Returns the points with columns `distance`, `gradient`, `closest`, `site` and `triangle`. The gradient has length 1.
/// Outside it points away from the surface, and inside towards it. It is NaN where it is not given. `site` and
/// `triangle` are -1 if nothing was found.
/// @param gradients  one for each point.
[[nodiscard]] Complex points_with_distances(std::span<const Vec3d> points, std::span<const ClosestPoint> found,
                                            std::span<const std::optional<Vec3d>> gradients);

}  // namespace blum::cli
