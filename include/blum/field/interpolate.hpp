// Blum: distances between the nodes of a field. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/vec3.hpp"
#include "blum/field/field.hpp"

namespace blum {

/// Returns the distance at any points, interpolated trilinearly between the eight nodes around each point. The result
/// is not exact; use closest_points() for exact distances. Near edges and bisectors of the shape, its error is up to
/// about half the diagonal of a cell. Here, a cell is the box between eight neighbouring nodes. Where the distance is
/// smooth, the error is O(spacing^2).
///
/// @param field   field.grid must be valid. Nodes beyond a band have the distance +-band.
/// @param points  finite, mesh units.
/// @return        distances in mesh units, one per point, in the order of the points; NaN for points outside of the
///                grid. If an axis has a single layer, points within half a spacing of the layer are in the grid and
///                get its value.
/// @throws InvalidGrid, also if the numbers of distances and nodes differ.
/// @throws InvalidOption with the index of the first point that is not finite.
/// @throws Cancelled.
/// Cost: O(points).
[[nodiscard]] std::vector<double> interpolate(const Field& field, std::span<const Vec3d> points,
                                              const Context& context = {});

/// Interpolated distances and their gradients, one per point.
struct InterpolatedGradients {
  std::vector<double> value;    ///< the results of interpolate(), bit for bit
  std::vector<Vec3d> gradient;  ///< without unit (distance over length), in the mesh's axes
};

/// Returns the values and the gradients of the trilinear interpolation. The gradient has a length of about 1 where the
/// distance is smooth, and is shorter near edges and bisectors. The gradient jumps at the borders of cells. A point on
/// a border gets the gradient of the cell with the larger indices. A point in the last layer gets the gradient of the
/// cell before this layer. The component of the gradient along an axis with a single layer is 0. Outside of the grid,
/// the gradient is NaN. If a node of the cell is infinitely far, the gradient may be infinite or NaN.
[[nodiscard]] InterpolatedGradients interpolate_with_gradient(const Field& field, std::span<const Vec3d> points,
                                                              const Context& context = {});

}  // namespace blum
