// Blum: points and what is closest to them, as columns of files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "blum/complex/complex.hpp"
#include "blum/core/vec3.hpp"
#include "blum/field/closest_points.hpp"

namespace blum::cli {

/// The points, with columns `distance`, `gradient` (of length 1, away from the surface outside, towards it inside; not
/// a number on the surface, and where nothing was found), `closest`, `site` and `triangle` (-1 where there is none).
[[nodiscard]] Complex points_with_distances(std::span<const Vec3d> points, std::span<const ClosestPoint> found);

}  // namespace blum::cli
