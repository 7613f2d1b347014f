// Blum: powers of two that scale boxes to about 1, and enlarged boxes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "blum/core/scale.hpp"
#include "blum/core/vec3.hpp"

namespace blum {

/// Returns a power of two such that the box's longest side, multiplied by it, is about 1. Then products of lengths
/// neither overflow nor underflow.
[[nodiscard]] inline double unit_scale(const Box3& box) {
  const Vec3d size = box.size();
  return scale_to_one(std::max({size.x, size.y, size.z}));
}

/// Returns a power of two such that the box's largest coordinate, multiplied by it, is about 1.
[[nodiscard]] inline double coordinate_scale(const Box3& box) {
  return scale_to_one(box.largest_coordinate());
}

/// Returns the box enlarged by a margin on all sides; an empty box stays empty.
[[nodiscard]] inline Box3 grown(const Box3& box, double margin) {
  if (box.is_empty()) return box;
  const Vec3d by{margin, margin, margin};
  return {box.lower - by, box.upper + by};
}

}  // namespace blum
