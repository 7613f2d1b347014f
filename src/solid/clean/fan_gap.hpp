// Blum: how far a fan of triangles moves when its apex does. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "blum/core/vec3.hpp"

namespace blum::detail {

/// A bound on the Hausdorff distance of two fans of triangles over one polygon, rounding included: one from `apex` to
/// the sides of the polygon, one from its first corner. Infinity where no bound is known, as the fans do not both lie
/// like graphs of functions over one plane, or not clearly.
///
/// @param ring    corners of the polygon in order, two or more, relative to a point near by.
/// @param closed  whether the apex lies inside of the polygon; else on its side from the last corner to the first.
/// @param enough  where a quick bound is at most this, it is good enough.
/// Method: docs/theory/solid.md. Cost: the square of the number of corners, for up to 40; else their number.
[[nodiscard]] double fan_gap(std::span<const Vec3d> ring, const Vec3d& apex, bool closed, double enough);

}  // namespace blum::detail
