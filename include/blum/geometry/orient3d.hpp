// Blum: the exact side of a plane on which a point lies. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/vec3.hpp"

namespace blum::detail {

/// Bound on the relative error of the determinant of three differences, computed in double precision. The error is
/// relative to the sum of the magnitudes of the determinant's products. The bound is (7 + 56 u) u, with u = 2^-53,
/// rounded up.
inline constexpr double orient3d_rounding = 8e-16;

/// Returns the sign (-1, 0, 1) of the determinant of b - a, c - a, d - a. The sign is 1 if the triangle a, b, c turns
/// counter-clockwise seen from d. The sign is exact for coordinates that are 0 or of magnitude 1e-80 to 1e100.
///
/// A determinant in double precision nearly always decides; otherwise, the determinant is computed in twice that
/// precision. If twice the precision does not decide, the determinant is summed without error (Shewchuk 1997). The
/// determinants in double, twice double and exact arithmetic take about 10 ns, 0.2 us and 0.5 to 10 us.
[[nodiscard]] int orient3d(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d);

}  // namespace blum::detail
