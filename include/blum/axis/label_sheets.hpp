// Blum: sheets, seams, rims and junctions of a complex. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/complex/complex.hpp"
#include "blum/complex/incidence.hpp"

namespace blum::detail {

/// Numbers the sheets of a medial axis whose vertices and triangles are there, adds its rims and seams to the edges,
/// which hold its curves, and tells the role of each vertex. Sheets are numbered by their first triangle,
/// until order_sheets() does better.
/// @param incidence  of the axis as it is given.
void label_sheets(Complex& axis, const Incidence& incidence);

}  // namespace blum::detail
