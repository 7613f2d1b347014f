// Blum: folds in the sheets of an axis. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// Up to which length edges are contracted, in voxels.
struct ShortLengths {
  double others = 0.15;
  double on_seams = 0.15;  ///< between two vertices of seams or curves
  double on_rims = 0.15;   ///< between two vertices of rims
  double of_crumbs = 0;    ///< of sheets of a few triangles
  double at_corners = 0;   ///< from a vertex of a rim to where a seam ends: rims meet there, and cut no corner
  double of_slivers = 0;   ///< the shortest sides of triangles between borders whose corners lie on a line
};

/// Contracts edges much shorter than a voxel where that keeps the homotopy type and edges in the solid: ribbons become
/// curves, and two seams beside each other one.
/// @param incidence  of the lists as they are.
/// @param voxel      mesh units.
/// @return           whether any edge was contracted.
/// @throws Cancelled. Cost: near-linear.
bool contract_short(AxisLists& lists, const Incidence& incidence, const Surface& surface, double voxel,
                    const ShortLengths& lengths, const Context& context);

/// Where unfold() looks.
struct UnfoldLimits {
  double voxel = 0;               ///< mesh units
  double most_radius = HUGE_VAL;  ///< mesh units: at vertices with larger ones nothing is done
};

/// Where two triangles of a sheet lie one over the other, as vertices that were moved leave them, contracts the edge
/// next to them that takes most of such folds away. Seams stay on seams and rims on rims; homotopy type and solid as in
/// contract_short(). @param incidence  of the lists as they are.
/// @return  whether any was contracted.  @throws Cancelled. Cost: near-linear.
bool unfold(AxisLists& lists, const Incidence& incidence, const Surface& surface, const UnfoldLimits& limits,
            const Context& context);

}  // namespace blum::detail
