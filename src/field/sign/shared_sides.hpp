// Blum: sides and winding numbers of points that lie close together, by those of a few. SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "blum/core/vec3.hpp"
#include "blum/geometry/winding_number.hpp"

namespace blum::sign {

/// A point off the surface, and whether its winding number is above 1/2.
struct SidedPoint {
  Vec3d at;
  double distance = 0;  ///< from the surface, > 0, off by no more than the slack
  bool is_inside = false;
};

/// At most so many at once.
inline constexpr std::size_t most_shared = 256;

/// Decides as WindingNumber::is_inside() does, for points in an order in which neighbours come together.
///
/// A few points ask for themselves, those far from the surface first. Others take their answer from one of these where
/// nothing can lie between: no triangle, as the distances of both add up to more than the way between them, and no
/// change of the winding number across 1/2, as its gradient on the way is bounded (WindingNumber::gradient_bound). Next
/// to the rims of holes the bound is useless, and each asks for itself.
///
/// @param points  at most most_shared.
/// @param slack   how far the sum of two distances may be off, mesh units.
/// Allocates nothing.
void decide_sides(const WindingNumber& winding, std::span<SidedPoint> points, double slack);

/// A point off the surface, and its winding number to within WindingNumber::rough_error.
struct NumberedPoint {
  Vec3d at;
  double distance = 0;  ///< as of SidedPoint
  double number = 0;
};

/// Finds rough winding numbers in the same way.
void find_rough_numbers(const WindingNumber& winding, std::span<NumberedPoint> points, double slack);

}  // namespace blum::sign
