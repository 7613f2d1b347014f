// Blum: medial axes from walls by collapses. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"

namespace blum {

/// Returns the part of a medial axis with separation angles above theta, and the other cells that its homotopy type
/// needs.
///
/// Triangles of at most theta are removed by elementary collapses from free edges of at most theta, the smallest angle
/// first. Then edges of no triangle are removed from free ends. Neither such an edge nor any triangle that was at it
/// may have an angle above theta. The angle of an edge is the smaller one at its two ends. Along seams it is larger
/// than that of the triangles beside them. The homotopy type is preserved, and the result for a larger theta is part of
/// that for a smaller one. The order is that of Liu, Chambers, Letscher, Ju 2010, for complexes of triangles (see also
/// Sud 2006, 5.6).
///
/// @param walls  triangles with the columns of voronoi_complex() for the part medial_axis: vertices `radius`,
///               footprints, sites and `separation_angle`, triangles `separation_angle`. Other columns of vertices and
///               triangles are kept. Listed edges are dropped.
/// @param theta  degrees, 0 to 180. At 0, only cells with an angle of 0 are removed.
/// @return       with the columns of MedialView; sheets are numbered by their first triangle.
/// @throws InvalidOption if theta is out of range or a column is missing; InvalidMesh with the text of
/// problem_of(walls); Cancelled.
/// Cost: O(n log n) in the triangles, about 1 us each.
[[nodiscard]] Complex collapse_axis(const Complex& walls, double theta, const Context& context = {});

}  // namespace blum
