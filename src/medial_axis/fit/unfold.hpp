// Blum: removal of short edges and folds in the sheets of an axis. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// Lengths up to which edges are contracted, in voxels.
struct ShortLengths {
  double others = 0.15;
  double on_seams = 0.15;  ///< Between two vertices of seams or curves.
  double on_rims = 0.15;   ///< Between two vertices of rims.
  double of_crumbs = 0;    ///< Edges of sheets of a few triangles.
  double at_corners = 0;   ///< From a vertex of a rim to the end of a seam: rims meet there and cut no corner.
  double of_slivers = 0;   ///< Shortest sides of triangles between borders whose corners lie on a line.
};

/// Contracts edges much shorter than a voxel if that keeps the homotopy type and keeps edges in the solid. Ribbons
/// become curves, and two adjacent seams become one.
/// @param incidence  of the lists as they are.
/// @param voxel      mesh units.
/// @return           true if any edge was contracted.
/// @throws Cancelled. Cost: near-linear.
bool contract_short(AxisLists& lists, const Incidence& incidence, const Surface& surface, double voxel,
                    const ShortLengths& lengths, const Context& context);

/// Limits of unfold().
struct UnfoldLimits {
  double voxel = 0;               ///< mesh units
  double most_radius = HUGE_VAL;  ///< mesh units: vertices with larger radii are left alone
};

/// Contracts edges where two triangles of a sheet lie one over the other, as moved vertices leave them. At each such
/// fold it contracts the adjacent edge that removes most folds. Seams stay on seams and rims on rims. The homotopy type
/// is kept and edges stay in the solid, as in contract_short().
/// @param incidence  of the lists as they are.
/// @return  true if any edge was contracted.  @throws Cancelled. Cost: near-linear.
bool unfold(AxisLists& lists, const Incidence& incidence, const Surface& surface, const UnfoldLimits& limits,
            const Context& context);

}  // namespace blum::detail
