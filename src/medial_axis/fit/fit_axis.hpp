// Blum: fits the borders of an axis to their exact places. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "blum/core/context.hpp"
#include "blum/core/ids.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// Solid and limits to which borders are fitted.
struct FitTarget {
  const Surface& surface;
  std::function<SiteId(SiteId)> input_site;  ///< Returns the input's site for a site of the surface.
  double voxel = 0;                          ///< Mesh units. One step moves a vertex by at most about 4 of them.
  double theta = 0;                          ///< Degrees.
  double tolerance = 0;                      ///< Mesh units, of thin_insides(). If it is 0, this step is skipped.
};

/// Moves the borders of the sheets of an axis from near the cells of a lattice to their places. Seams and junctions go
/// to where three or four walls are equally far. Rims and ends go to where the separation angle is theta or the radius
/// a fiftieth of a voxel. Cells beyond are removed first (trim()). Edges between vertices that come to the same place
/// are contracted, so that ribbons without width become curves. All steps keep the homotopy type, and keep edges in the
/// solid.
/// @param lists  of one body.
/// @return       largest move of the insides of sheets, mesh units.
/// @throws Cancelled. Cost: linear in the vertices that move, about 0.1 ms for each.
double fit_axis(AxisLists& lists, const FitTarget& target, const Context& context);

}  // namespace blum::detail
