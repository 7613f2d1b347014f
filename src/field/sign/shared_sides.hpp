// Blum: sides and winding numbers of points that lie close together. Only a few of the points are evaluated.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "blum/core/vec3.hpp"
#include "blum/geometry/winding_number.hpp"

namespace blum::sign {

/// Point that is not on the surface. The point is inside if its winding number is above 1/2.
struct SidedPoint {
  Vec3d at;
  double distance = 0;  ///< distance from the surface, above 0. Its error is covered by the `slack` of decide_sides().
  bool is_inside = false;
};

/// Largest number of points per call.
inline constexpr std::size_t most_shared = 256;

/// Decides sides as WindingNumber::is_inside() does. The points must be in an order in which neighbours follow each
/// other.
///
/// Only a few points are evaluated, first those furthest from the surface. Another point takes over an answer if both
/// points certainly have the same side. No triangle lies between two points whose distances add up to more than the
/// distance between them. The winding number does not cross 1/2 between them if the bound on its gradient excludes it
/// (WindingNumber::gradient_bound). Near the rims of holes this bound is too large to be useful, and each point is
/// evaluated.
///
/// @param points  at most most_shared.
/// @param slack   bound on the error of the sum of two distances, mesh units.
/// Allocates nothing.
void decide_sides(const WindingNumber& winding, std::span<SidedPoint> points, double slack);

/// Point that is not on the surface, and its winding number. The error is at most WindingNumber::rough_error.
struct NumberedPoint {
  Vec3d at;
  double distance = 0;  ///< as in SidedPoint
  double number = 0;
};

/// Finds rough winding numbers of points. Points share winding numbers as in decide_sides().
void find_rough_numbers(const WindingNumber& winding, std::span<NumberedPoint> points, double slack);

}  // namespace blum::sign
