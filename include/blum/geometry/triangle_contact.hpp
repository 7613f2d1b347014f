// Blum: exact contact of two triangles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "blum/core/vec3.hpp"

namespace blum::detail {

struct ContactTriangle {
  std::array<Vec3d, 3> points;
  /// Numbers of the corners. Corners of two triangles with equal numbers are the same corner. Corners at equal points
  /// must have equal numbers.
  std::array<std::uint32_t, 3> corners;
};

/// Returns true if the three points lie exactly on one line.
[[nodiscard]] bool has_no_area(const std::array<Vec3d, 3>& points);

/// Kind of the common points of two triangles, except for the points of a shared corner or a shared edge.
enum class Contact : std::uint8_t {
  none,
  touching,  ///< the triangles have common points, but none is inside both triangles; or they overlap in one plane
  crossing   ///< the triangles lie in different planes, and some points are inside both
};

/// Returns the contact of two triangles. Both triangles must have an area. The result is exact for coordinates that are
/// 0 or of magnitude 1e-80 to 1e100. Method: signs of determinants only (Guigue, Devillers 2003). Shared corners are
/// handled first, as separate cases.
[[nodiscard]] Contact contact(const ContactTriangle& a, const ContactTriangle& b);

}  // namespace blum::detail
