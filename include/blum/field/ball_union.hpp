// Blum: distance fields of unions of balls. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/vec3.hpp"
#include "blum/field/field.hpp"
#include "blum/grid/grid_spec.hpp"

namespace blum {

/// Closed ball. With radius 0 it is a point.
struct Ball {
  Vec3d centre;
  double radius = 0;  ///< >= 0, mesh units
};

/// Returns the box around balls, for grid_around(). Without balls it is empty.
[[nodiscard]] Box3 bounds(std::span<const Ball> balls);

/// Computes, at every node x of a grid, the smallest |x - centre| - radius over all balls. The zero_surface() of this
/// field is the boundary of the union.
///
/// @param balls  1 to max_id_count balls, in any order, repeated or not. Centres must be finite, of magnitude at most
///               1e37. Radii must be 0 to 1e37.
/// @param grid   must pass validate(grid).
/// @return       a field. Outside of the union, a value is the distance to the union. Inside, it is negative: its
///               magnitude is the largest depth of the node in any ball. That depth is a lower bound of the distance to
///               the boundary of the union. Values are computed in double and rounded to float. Field::site is empty,
///               because its ids do not number balls. Field::sign_rule is `balls`. The bytes are the same for any
///               number of threads.
/// @throws InvalidOption if a ball is out of range, or the list is empty.
/// @throws InvalidGrid, OutOfMemory, Cancelled.
/// Cost: about O(nodes log(nodes)), as long as no region has more balls than nodes. On one core, at 256^3 nodes, it
/// takes 1.5 s for 40,000 balls of a curved sheet. For 300,000 balls at random positions it takes 2 s. Where balls lie
/// much closer together than nodes, the cost is proportional to the balls (10 s for 300,000 points of a sphere). The
/// worst case is O(nodes * balls), if all balls are equally far from all nodes.
/// Method: octants of octants of the grid, each with the balls that may be the closest somewhere in it.
[[nodiscard]] Field ball_union_field(std::span<const Ball> balls, const GridSpec& grid, const Context& context = {});

}  // namespace blum
