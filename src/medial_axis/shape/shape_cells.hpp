// Blum: edges and triangles of the cells of a medial axis. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "medial_axis/shape/axis_corners.hpp"
#include "medial_axis/shape/axis_piece.hpp"
#include "medial_axis/shape/witnesses.hpp"

namespace blum::detail {

/// Computes the segments of edges and the triangles of polygons, between the vertices of a piece. For a polyhedron,
/// shapes that stay in the solid are preferred. An edge that would leave the solid gets vertices at points of the
/// component that it represents. A polygon that would leave it gets a vertex in its middle. If a shape still leaves the
/// solid, `piece.leaving` lists the boxes of the cell's vertices.
void shape_cells(AxisPiece& piece, const AxisCorners& corners, const Witnesses& witnesses, const Context& context);

}  // namespace blum::detail
