// Blum: fits the borders of an axis to their exact places. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "blum/core/context.hpp"
#include "blum/core/ids.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// Surface of the solid to which borders are fitted, and limits.
struct FitTarget {
  const Surface& surface;
  std::function<SiteId(SiteId)> input_site;  ///< Returns the input's site for a site of the surface.
  /// Mesh units: side of a voxel. One step moves a vertex by at most about 4 voxels.
  double voxel = 0;
  double theta = 0;  ///< Degrees.
  /// Mesh units: tolerance of thin_insides(). If it is 0, that step is skipped.
  double tolerance = 0;
};

/// Moves the borders of the sheets of an axis, which so far follow the cells of a lattice, to their exact positions.
/// Seams move to where three walls are equally far, junctions to where four are. Rims, and ends of seams and curves,
/// move to where the separation angle is theta or the radius 1/50 of a voxel. Cells beyond these borders are removed
/// first (trim()). If two adjacent vertices move to the same point, the edge between them is contracted, so that
/// ribbons without width become curves. All steps keep the homotopy type, and keep edges in the solid.
/// @param lists  the axis of one body.
/// @return       mesh units: greatest distance that thin_insides() moved sheets.
/// @throws Cancelled. Cost: linear in the number of vertices that move, about 0.1 ms for each.
double fit_axis(AxisLists& lists, const FitTarget& target, const Context& context);

}  // namespace blum::detail
