// Blum: the edges and triangles that the cells of a medial axis consist of. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "medial_axis/shape/axis_corners.hpp"
#include "medial_axis/shape/axis_piece.hpp"
#include "medial_axis/shape/witnesses.hpp"

namespace blum::detail {

/// Makes segments of edges and triangles of polygons, between the vertices that were placed. Of a polyhedron none of
/// these leaves the solid where that can be helped: edges that would are led through points of the components that
/// they stand for, polygons that would get a vertex in their middle. Where that is not found, the piece has the boxes
/// of the cell.
void shape_cells(AxisPiece& piece, const AxisCorners& corners, const Witnesses& witnesses, const Context& context);

}  // namespace blum::detail
