// Blum: whether two triangles cross, exactly. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "blum/core/vec3.hpp"

namespace blum::detail {

struct ContactTriangle {
  std::array<Vec3d, 3> points;
  /// Corners of two triangles are the same corner where these are equal, which must be so where the points are.
  std::array<std::uint32_t, 3> corners;
};

/// Whether the corners lie exactly on one line.
[[nodiscard]] bool has_no_area(const std::array<Vec3d, 3>& points);

/// What two triangles have in common besides a shared corner or a shared edge.
enum class Contact : std::uint8_t {
  none,
  touching,  ///< points, but none that is inside both, unless they lie in one plane and overlap
  crossing   ///< in two planes, and points inside both
};

/// Exact for coordinates of magnitude 1e-80 to 1e100, or 0. Both triangles must have an area.
/// Method: signs of determinants only (Guigue, Devillers 2003), with the cases of shared corners told apart first.
[[nodiscard]] Contact contact(const ContactTriangle& a, const ContactTriangle& b);

}  // namespace blum::detail
