// Blum: sides and winding numbers of points that lie close together, from those of a few of them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "blum/core/vec3.hpp"
#include "blum/geometry/winding_number.hpp"

namespace blum::sign {

/// Point off the surface. It is inside if its winding number is above 1/2.
struct SidedPoint {
  Vec3d at;
  double distance = 0;  ///< from the surface, > 0, off by at most the slack
  bool is_inside = false;
};

/// Largest number of points per call.
inline constexpr std::size_t most_shared = 256;

/// Decides sides as WindingNumber::is_inside() does. The points come in an order in which neighbours follow each other.
///
/// Only a few points are evaluated, those furthest from the surface first. Other points take over such an answer if
/// nothing can lie between. No triangle lies between two points whose distances add up to more than the way between
/// them. The winding number does not cross 1/2 on the way if the bound of its gradient excludes it
/// (WindingNumber::gradient_bound). Next to the rims of holes this bound is useless, and each point is evaluated.
///
/// @param points  at most most_shared.
/// @param slack   bound on the error of the sum of two distances, mesh units.
/// Allocates nothing.
void decide_sides(const WindingNumber& winding, std::span<SidedPoint> points, double slack);

/// Point off the surface, and its winding number to within WindingNumber::rough_error.
struct NumberedPoint {
  Vec3d at;
  double distance = 0;  ///< as in SidedPoint
  double number = 0;
};

/// Finds rough winding numbers in the same way.
void find_rough_numbers(const WindingNumber& winding, std::span<NumberedPoint> points, double slack);

}  // namespace blum::sign
