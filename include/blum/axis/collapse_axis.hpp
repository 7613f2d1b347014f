// Blum: medial axes from walls by collapses. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"

namespace blum {

/// Returns the triangles and edges of a medial axis whose separation angle is above theta. The result also contains the
/// triangles and edges that are needed to preserve the homotopy type.
///
/// Triangles are removed by elementary collapses, the triangle with the smallest angle first. A collapse removes a
/// triangle together with a free edge: an edge that belongs to no other triangle. The angles of the triangle and of the
/// edge must be at most theta. After that, each edge without triangles is removed together with one of its vertices, if
/// the vertex belongs to no other edge. An edge without triangles is kept if its angle, or the angle of a removed
/// triangle that contained it, is above theta. The angle of an edge is the smaller angle of its two vertices. Along a
/// seam, the angle of an edge is larger than the angles of the edge's triangles. The homotopy type is preserved. The
/// result for a larger theta is part of the result for a smaller theta. The order of removal is that of Liu, Chambers,
/// Letscher, Ju 2010, applied to complexes of triangles (see also Sud 2006, 5.6).
///
/// @param walls  triangles with the columns that voronoi_complex() computes for VoronoiPart::medial_axis. Vertices need
///               `radius`, footprints, sites and `separation_angle`; triangles need `separation_angle`. Other columns
///               of vertices and triangles are kept. Listed edges are ignored.
/// @param theta  degrees, 0 to 180. At 0, only triangles and edges with an angle of 0 are removed.
/// @return       complex with the columns of MedialView. Sheets are numbered in the order of their first triangles. If
///               the walls have the columns of add_patch_columns(), label_patch_sheets() adds sheets of patches.
/// @throws InvalidOption if theta is out of range or a column is missing; InvalidMesh with the text of
/// problem_of(walls); Cancelled.
/// Cost: O(n log n) for n triangles, about 1 us per triangle.
[[nodiscard]] Complex collapse_axis(const Complex& walls, double theta, const Context& context = {});

}  // namespace blum
