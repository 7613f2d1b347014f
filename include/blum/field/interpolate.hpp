// Blum: distances between the nodes of a field. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/vec3.hpp"
#include "blum/field/field.hpp"

namespace blum {

/// Returns the distance at any points, trilinear between the eight nodes around each. It is not exact. Next to edges
/// and bisectors of the shape it is off by up to about half the diagonal of a cell. Where the distance is smooth, it is
/// off by O(spacing^2). closest_points() is exact.
///
/// @param field   field.grid must be valid. Beyond a band, +-band counts as the distance.
/// @param points  finite, mesh units.
/// @return        mesh units, one per point, in their order; NaN for points outside of the grid. Along an axis with a
///                single layer, points within half a spacing of it lie in the grid and take its value.
/// @throws InvalidGrid, also if the counts of distances and nodes differ.
/// @throws InvalidOption that names the first point that is not finite.
/// @throws Cancelled.
/// Cost: O(points).
[[nodiscard]] std::vector<double> interpolate(const Field& field, std::span<const Vec3d> points,
                                              const Context& context = {});

/// Values of the interpolant and its gradients.
struct InterpolatedGradients {
  std::vector<double> value;    ///< those of interpolate(), bit for bit
  std::vector<Vec3d> gradient;  ///< without unit (distance over length), in the mesh's axes
};

/// Returns the values and the gradient of the trilinear interpolant. The gradient has a length of about 1 where the
/// distance is smooth, and less next to edges and bisectors. It jumps at the borders of cells. There it is that of the
/// cell with the higher nodes; in the last layer, that of the cell before. Along an axis with a single layer it is 0.
/// It is NaN outside of the grid, and if a node of the cell is infinitely far.
[[nodiscard]] InterpolatedGradients interpolate_with_gradient(const Field& field, std::span<const Vec3d> points,
                                                              const Context& context = {});

}  // namespace blum
