// Blum: edges of medial axes without length. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/complex/complex.hpp"
#include "blum/complex/incidence.hpp"

namespace blum::detail {

/// Contracts edges whose ends are at the same place, one after the other, where that changes no homotopy type: where
/// what is linked to both ends is linked to the edge (the link condition; Dey, Edelsbrunner, Guha, Nekhayev, "Topology
/// preserving edge contraction", 1999; Attali, Lieutier, Salinas, "Efficient data structure for representing and
/// simplifying simplicial complexes in high dimensions", 2012). Nothing moves. Triangles without area go; where they
/// were a ribbon around a curve the curve is left.
/// @param axis       with edges of curves only; sheets and roles are to be labelled afterwards.
/// @param incidence  of the axis as it is given.
/// @return           whether there were such edges; the axis may differ only then.
bool contract_points(Complex& axis, const Incidence& incidence);

}  // namespace blum::detail
