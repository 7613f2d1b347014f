// Blum: cubes that do not pass, as lines of a complex. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "blum/complex/complex.hpp"
#include "blum/voronoi/voronoi_complex.hpp"

namespace blum {

/// Adds the twelve sides of each cube as edges, so that a complex that is not certified shows where it may be wrong.
///
/// @param complex  as voronoi_complex() makes it: without edges. Its columns of vertices are 0 at the corners of cubes,
///                 `site_0` and `site_1`, where it has them, -1. Edges get a column `obstacle` (int32: the number of
///                 the VoronoiObstacle that keeps the cube from passing).
/// @param failing  of its report.
/// @throws InvalidOption for a complex with edges, and where there would be more vertices than ids.
void add_failing_cells(Complex& complex, std::span<const FailingVoronoiCell> failing);

}  // namespace blum
