// Blum: small sheets that lie on others. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"
#include "medial_axis/shape/axis_lists.hpp"

namespace blum {

/// What take_crumbs() takes away.
struct CrumbLimits {
  double area = 0;    ///< square mesh units: sheets up to this size,
  double beside = 0;  ///< mesh units: whose points are this close to the triangles of other sheets around them
};

/// Takes away small sheets that lie on the sheets that they are attached to, as contractions in thin walls leave them:
/// collapses each from its free borders, or leaves it whole where that would leave something of it. The homotopy type
/// stays, and what is left is as it was.
/// @param incidence  of the lists.
/// @return  whether there were any.  @throws Cancelled. Cost: linear in the lists, near-linear in what is taken.
bool take_crumbs(AxisLists& lists, const Incidence& incidence, const CrumbLimits& limits, const Context& context);

}  // namespace blum
