// Blum: angles, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

#include "blum/core/vec3.hpp"

namespace blum::verifier {

inline constexpr double degrees_per_radian = 180 / std::numbers::pi;

/// Returns the angle between two vectors in degrees; 0 if one of them has no length.
[[nodiscard]] inline double degrees_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) * degrees_per_radian;
}

}  // namespace blum::verifier
