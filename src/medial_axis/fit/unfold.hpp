// Blum: removal of short edges and folds in the sheets of an axis. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// Greatest lengths of edges that are contracted, in voxels, by the kind of the edge.
struct ShortLengths {
  double others = 0.15;
  double on_seams = 0.15;  ///< Between two vertices of seams or curves.
  double on_rims = 0.15;   ///< Between two vertices of rims.
  double of_crumbs = 0;    ///< Edges of sheets of at most 8 triangles.
  /// From a vertex of a rim to the end of a seam in a corner of the solid, so that rims meet in the corner.
  double at_corners = 0;
  double of_slivers = 0;  ///< Shortest sides of triangles whose corners all lie on borders and nearly on one line.
};

/// Contracts edges much shorter than a voxel if that keeps the homotopy type and keeps edges in the solid. Ribbons
/// become curves, and two adjacent seams become one.
/// @param incidence  the incidence of the lists before the call.
/// @param voxel      mesh units.
/// @return           true if any edge was contracted.
/// @throws Cancelled. Cost: near-linear.
bool contract_short(AxisLists& lists, const Incidence& incidence, const Surface& surface, double voxel,
                    const ShortLengths& lengths, const Context& context);

/// Limits of unfold().
struct UnfoldLimits {
  double voxel = 0;               ///< mesh units
  double most_radius = HUGE_VAL;  ///< mesh units: vertices with larger radii are not moved
};

/// Contracts edges where two triangles of a sheet are folded onto each other. Moves of vertices cause such folds. At
/// each fold, it contracts the nearby edge whose contraction removes most folds. Vertices of seams move only along
/// seams, and vertices of rims only along rims. The homotopy type is kept and edges stay in the solid, as in
/// contract_short().
/// @param incidence  the incidence of the lists before the call.
/// @return  true if any edge was contracted.  @throws Cancelled. Cost: near-linear.
bool unfold(AxisLists& lists, const Incidence& incidence, const Surface& surface, const UnfoldLimits& limits,
            const Context& context);

}  // namespace blum::detail
