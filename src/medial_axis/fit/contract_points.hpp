// Blum: contraction of edges of medial axes without length. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/complex/complex.hpp"
#include "blum/complex/incidence.hpp"

namespace blum::detail {

/// Contracts edges whose ends are at the same place, one after the other, if the homotopy type stays. The link
/// condition decides: all that is linked to both ends must be linked to the edge. Sources: Dey, Edelsbrunner, Guha,
/// Nekhayev, "Topology preserving edge contraction", 1999. Attali, Lieutier, Salinas, "Efficient data structure for
/// representing and simplifying simplicial complexes in high dimensions", 2012. Nothing moves. Triangles without area
/// are removed. If they were a ribbon around a curve, the curve is left.
/// @param axis       with edges of curves only. Sheets and roles must be labelled afterwards.
/// @param incidence  of the axis as it is given.
/// @return           true if such edges existed. Only then the axis may differ.
bool contract_points(Complex& axis, const Incidence& incidence);

}  // namespace blum::detail
