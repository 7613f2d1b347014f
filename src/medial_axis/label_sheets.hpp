// Blum: sheets, seams, rims and junctions of a complex. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "blum/medial_axis/medial_complex.hpp"

namespace blum {

/// Numbers the sheets of a complex whose vertices and triangles are there, adds its rims and seams to the edges, which
/// hold its curves, and tells the role of each vertex. Sheets are numbered by their first triangle.
void label_sheets(MedialComplex& complex);

}  // namespace blum
