// Blum: the side of a plane that a point lies on, exactly. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/vec3.hpp"

namespace blum::detail {

/// A determinant of three differences in double is wrong by less than this part of the sum of the magnitudes of its
/// products: (7 + 56 u) u, with u = 2^-53, rounded up.
inline constexpr double orient3d_rounding = 8e-16;

/// The sign (-1, 0, 1) of the determinant of b - a, c - a, d - a: 1 when d lies on the side of the plane a, b, c that
/// the triangle turns counter-clockwise seen from. Exact for coordinates of magnitude 1e-80 to 1e100, or 0.
///
/// A filter in double answers nearly always, then one in twice that precision; what both leave open is summed without
/// error (Shewchuk 1997). About 10 ns, 0.2 us and 0.5 to 10 us.
[[nodiscard]] int orient3d(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d);

}  // namespace blum::detail
