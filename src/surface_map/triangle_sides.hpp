// Blum: sides and centroids of triangles in space. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "blum/core/vec3.hpp"

namespace blum::surface {

/// Returns the squared lengths of a triangle's sides. Side k goes from corner k to the next one.
[[nodiscard]] inline std::array<double, 3> squared_sides(const std::array<Vec3d, 3>& p) {
  return {squared_length(p[1] - p[0]), squared_length(p[2] - p[1]), squared_length(p[0] - p[2])};
}

/// Returns the first side with the largest squared length.
[[nodiscard]] inline std::size_t longest_of(const std::array<double, 3>& squared) {
  return static_cast<std::size_t>(std::max_element(squared.begin(), squared.end()) - squared.begin());
}

[[nodiscard]] inline Vec3d centroid_of(const std::array<Vec3d, 3>& corners) {
  return (corners[0] + corners[1] + corners[2]) / 3.0;
}

}  // namespace blum::surface
