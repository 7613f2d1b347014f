// Blum: distances between the nodes of a field. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/vec3.hpp"
#include "blum/field/field.hpp"

namespace blum {

/// The distance at any points, trilinear between the eight nodes around each. Not exact: off by up to about half the
/// diagonal of a cell next to edges and bisectors of the shape, and by O(spacing^2) where the distance is smooth.
/// closest_points() is exact.
///
/// @param field   field.grid must be valid. Beyond a band, +-band counts as the distance.
/// @param points  finite, mesh units.
/// @return        mesh units, one per point, in their order; not a number at points outside of the grid. Along an axis
///                with a single layer, points within half a spacing of it lie in the grid, and take its value.
/// @throws InvalidGrid (also where there are not as many distances as nodes), InvalidOption naming the first point that
/// is not finite, Cancelled. Cost: O(points).
[[nodiscard]] std::vector<double> interpolate(const Field& field, std::span<const Vec3d> points,
                                              const Context& context = {});

/// Values of the interpolant, and its gradients.
struct InterpolatedGradients {
  std::vector<double> value;    ///< as interpolate() gives them, bit for bit
  std::vector<Vec3d> gradient;  ///< without unit (distance over length), in the mesh's axes
};

/// The same with the gradient of what is trilinear between the nodes: about 1 long where the distance is smooth,
/// shorter next to edges and bisectors. It jumps at the borders of cells: there it is that of the cell with the higher
/// nodes, in the last layer of the one before. 0 along an axis with a single layer. Not a number outside of the grid,
/// and where a node of the cell is infinitely far.
[[nodiscard]] InterpolatedGradients interpolate_with_gradient(const Field& field, std::span<const Vec3d> points,
                                                              const Context& context = {});

}  // namespace blum
