// Blum: edges of medial axes without length. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/medial_axis/medial_complex.hpp"

namespace blum {

/// Contracts edges whose ends are at the same place, one after the other, where that changes no homotopy type: where
/// what is linked to both ends is linked to the edge (the link condition; Dey, Edelsbrunner, Guha, Nekhayev, "Topology
/// preserving edge contraction", 1999; Attali, Lieutier, Salinas, "Efficient data structure for representing and
/// simplifying simplicial complexes in high dimensions", 2012). Nothing moves. Triangles without area go; where they
/// were a ribbon around a curve the curve is left.
/// @param complex  with edges of curves only; sheets and roles are to be labelled afterwards.
void contract_points(MedialComplex& complex);

}  // namespace blum
