// Blum: edges and triangles of the cells of a medial axis. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "medial_axis/shape/axis_corners.hpp"
#include "medial_axis/shape/axis_piece.hpp"
#include "medial_axis/shape/witnesses.hpp"

namespace blum::detail {

/// Makes segments of edges and triangles of polygons, between the placed vertices. For a polyhedron, none of these
/// leaves the solid if that can be avoided. Edges that would leave it are led through points of the components that
/// they stand for. Polygons that would leave it get a vertex in their middle. If that fails, `piece.leaving` lists the
/// boxes of the cell.
void shape_cells(AxisPiece& piece, const AxisCorners& corners, const Witnesses& witnesses, const Context& context);

}  // namespace blum::detail
