// Blum: folds in the sheets of an axis. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"
#include "medial_axis/shape/axis_lists.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

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
