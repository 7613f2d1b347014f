// Blum: cubes that do not pass, as lines of a complex. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "blum/complex/complex.hpp"
#include "blum/voronoi/voronoi_complex.hpp"

namespace blum {

/// Adds the twelve sides of each cube as edges. They show where a complex that is not certified may be wrong.
///
/// @param complex  result of voronoi_complex(), without edges. Its vertex columns are 0 at the corners of cubes;
///                 `site_0` and `site_1`, if they exist, are -1. Edges get the column `obstacle`, int32: the
///                 VoronoiObstacle of the cube.
/// @param failing  from its report.
/// @throws InvalidOption if the complex has edges, or would have more vertices than ids.
void add_failing_cells(Complex& complex, std::span<const FailingVoronoiCell> failing);

}  // namespace blum
