// Blum: the side of a plane that a point lies on, exactly. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/vec3.hpp"

namespace blum::detail {

/// Relative error bound of a determinant of three differences in double, as a part of the sum of the magnitudes of its
/// products. It is (7 + 56 u) u, with u = 2^-53, rounded up.
inline constexpr double orient3d_rounding = 8e-16;

/// Returns the sign (-1, 0, 1) of the determinant of b - a, c - a, d - a. It is 1 if the triangle a, b, c turns
/// counter-clockwise seen from d. It is exact for coordinates that are 0 or of magnitude 1e-80 to 1e100.
///
/// A filter in double nearly always answers; otherwise a filter in twice that precision is used. If both are undecided,
/// the determinant is summed without error (Shewchuk 1997). The three take about 10 ns, 0.2 us and 0.5 to 10 us.
[[nodiscard]] int orient3d(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d);

}  // namespace blum::detail
