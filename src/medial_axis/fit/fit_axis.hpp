// Blum: the borders of an axis where they belong. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "blum/core/context.hpp"
#include "blum/core/ids.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// What borders are fitted to.
struct FitTarget {
  const Surface& surface;
  std::function<SiteId(SiteId)> input_site;  ///< what vertices name for a site of the surface
  double voxel = 0;                          ///< mesh units: nothing moves by more than about 2.5 of them
  double theta = 0;                          ///< degrees
  double tolerance = 0;                      ///< mesh units: of thin_insides(), before all else; 0: nothing goes there
};

/// Moves what bounds the sheets of an axis from near the cells of a lattice to its place: seams and junctions to where
/// three or four walls are equally far, rims and ends to where the separation angle is theta or the radius a fiftieth
/// of a voxel. What lies beyond goes first (trim()), and edges between vertices that come to the same place are
/// contracted, so that ribbons without width become curves. All of it keeps the homotopy type, and edges in the solid.
/// @param lists  of one body.
/// @return       how far insides of sheets moved at most, mesh units.
/// @throws Cancelled. Cost: linear in the vertices that move, about 0.1 ms for each.
double fit_axis(AxisLists& lists, const FitTarget& target, const Context& context);

}  // namespace blum::detail
