// Blum: sheets, seams, rims and junctions of a complex. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/complex/complex.hpp"
#include "blum/complex/incidence.hpp"

namespace blum::detail {

/// Computes sheets, rims, seams and roles of a medial axis. Before the call, the axis lists only its curves as edges.
/// The function numbers the sheets in the order of their first triangles; order_sheets() may renumber them. The
/// function also adds rims and seams to the edges, and sets the role of each vertex.
/// @param incidence  incidences of the axis before the call.
void label_sheets(Complex& axis, const Incidence& incidence);

}  // namespace blum::detail
