// Blum: sheets with fewer vertices where fitting has nothing to do. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"
#include "medial_axis/fit/fit_axis.hpp"
#include "medial_axis/shape/axis_lists.hpp"

namespace blum::detail {

/// Takes vertices out of sheets, as decimate() does, but far from all that fitting may move: borders, seams and curves;
/// vertices that know of one wall only, see little more than theta, or lie next to the surface; and where a sheet
/// bends. Most vertices of large parts are none of these, and each step of fitting looks at all that there are.
/// @param incidence  of the lists.
/// @return  how far sheets moved at most, mesh units: a sixteenth of the tolerance of the target.
/// @throws Cancelled. Cost: near-linear, about 2 us for each vertex.
double thin_insides(AxisLists& lists, const Incidence& incidence, const FitTarget& target, const Context& context);

}  // namespace blum::detail
