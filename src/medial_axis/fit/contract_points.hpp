// Blum: contraction of edges of medial axes without length. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/complex/complex.hpp"
#include "blum/complex/incidence.hpp"

namespace blum::detail {

/// Contracts edges whose two ends have equal positions, one after the other, if the homotopy type stays. The link
/// condition decides: the intersection of the links of both ends must be the link of the edge. Sources: Dey,
/// Edelsbrunner, Guha, Nekhayev, "Topology preserving edge contraction", 1999. Attali, Lieutier, Salinas, "Efficient
/// data structure for representing and simplifying simplicial complexes in high dimensions", 2012. No vertex moves.
/// Only triangles without area are removed. A ribbon of such triangles around a curve becomes the curve.
/// @param axis       its edges must be those of curves only. Sheets and roles must be labelled afterwards.
/// @param incidence  the incidence of the axis before the call.
/// @return           true if an edge had ends with equal positions. If false, the axis did not change.
bool contract_points(Complex& axis, const Incidence& incidence);

}  // namespace blum::detail
