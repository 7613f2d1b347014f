// Blum: exact contact of two triangles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "blum/core/vec3.hpp"

namespace blum::detail {

struct ContactTriangle {
  std::array<Vec3d, 3> points;
  /// Corners of two triangles are the same corner if these numbers are equal. They must be equal if the points are.
  std::array<std::uint32_t, 3> corners;
};

/// Returns true if the corners lie exactly on one line.
[[nodiscard]] bool has_no_area(const std::array<Vec3d, 3>& points);

/// Common points of two triangles besides a shared corner or a shared edge.
enum class Contact : std::uint8_t {
  none,
  touching,  ///< common points, none of them inside both; or an overlap in one plane
  crossing   ///< in two planes, with points inside both
};

/// Returns the contact of two triangles. Both must have an area. Exact for coordinates that are 0 or of magnitude 1e-80
/// to 1e100. Method: signs of determinants only (Guigue, Devillers 2003). Shared corners are handled first, as separate
/// cases.
[[nodiscard]] Contact contact(const ContactTriangle& a, const ContactTriangle& b);

}  // namespace blum::detail
