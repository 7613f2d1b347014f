// Blum: joining of junctions that only rounding keeps apart. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "voronoi/planes/plane_structure.hpp"

namespace blum::voronoi {

/// How parts of a diagram were joined, mesh units.
struct JoinedJunctions {
  double distance = 0;  ///< within which parts were joined; 0 if none were
  double moved = 0;     ///< bound on the Hausdorff distance between the diagram before and after
};

/// Joins parts of a diagram that are close together. In a degenerate solid, like a cube, more than four regions meet in
/// a junction. If rounding moves the planes, the junction falls apart into several, with short seams and thin sheets
/// between them. This function restores the degenerate diagram.
///
/// The result must divide the solid into one region for each plane. If the result does not, more distant parts are also
/// joined: up to 1e-4 of the size, or up to the tolerance. If this does not help, nothing is joined.
/// @param tolerance  >= 0, mesh units. With 0, or more than 1e-2 of the size, nothing is joined.
/// @throws Cancelled.
JoinedJunctions restore_degenerate(PlaneStructure& structure, double tolerance, const Context& context);

}  // namespace blum::voronoi
