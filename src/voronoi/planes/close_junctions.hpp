// Blum: joining of junctions that only rounding keeps apart. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "voronoi/planes/plane_structure.hpp"

namespace blum::voronoi {

/// Joins parts of a diagram that lie within a tolerance of each other. In a degenerate solid, like a cube, more than
/// four regions meet in a junction. If rounding moves the planes, the junction falls apart into several, with short
/// seams and thin sheets between them. This function restores the degenerate diagram. Junctions within the tolerance
/// become one. A seam that passes a junction within the tolerance is divided there. Seams with the same ends become
/// one, and sheets without an area vanish. A junction vanishes if exactly two seams end there, between the same
/// regions.
///
/// The tolerance of a junction grows with its condition, up to 8 times: where planes meet at small angles, rounding
/// moves it further.
/// @param tolerance  >= 0, mesh units; 0 changes nothing.
/// @return a bound on the Hausdorff distance between the diagram before and after, mesh units.
/// @throws Cancelled.
double join_close_junctions(PlaneStructure& structure, double tolerance, const Context& context);

}  // namespace blum::voronoi
