// Blum: medial axes from walls by collapses. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"

namespace blum {

/// The part of a medial axis where two footprints are seen more than theta apart, and what homotopy needs to join it.
///
/// Triangles of at most theta go by elementary collapses from free edges of at most theta, the smallest angle first;
/// then edges of no triangle from free ends, where neither they nor a triangle there had more. The angle of an edge is
/// the smaller one of its ends': along seams more than that of the triangles beside them. So the homotopy type stays,
/// and what a larger theta leaves is part of what a smaller one does. (The order of Liu, Chambers, Letscher, Ju 2010,
/// for complexes of triangles; Sud 2006, 5.6.)
///
/// @param walls  triangles with the columns of voronoi_complex() for its part medial_axis: of vertices `radius`,
///               footprints, sites and `separation_angle`, of triangles `separation_angle`. Further ones stay. Edges
///               that are listed are dropped.
/// @param theta  degrees, 0 to 180. At 0 nothing goes but what has no angle at all.
/// @return       with the columns of MedialView; sheets are numbered by their first triangle.
/// @throws InvalidOption where a column is missing; InvalidMesh saying problem_of(walls); Cancelled.
/// Cost: O(n log n) in the triangles, about 1 us each.
[[nodiscard]] Complex collapse_axis(const Complex& walls, double theta, const Context& context = {});

}  // namespace blum
