// Blum: cubes that do not pass, as lines of a complex. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "blum/complex/complex.hpp"
#include "blum/voronoi/voronoi_complex.hpp"

namespace blum {

/// Adds the twelve edges of each failing cube to a complex. The edges show where a complex that is not certified may be
/// wrong.
///
/// @param complex  result of voronoi_complex(), without edges. At the new vertices, the columns `site_0` and `site_1`
/// (if present) are -1, and all other columns are 0. Edges get the column `obstacle` (int32): the VoronoiObstacle of
/// their cube.
/// @param failing  VoronoiReport::failing of the same result.
/// @throws InvalidOption if the complex has edges, or would have more than max_id_count vertices.
void add_failing_cells(Complex& complex, std::span<const FailingVoronoiCell> failing);

}  // namespace blum
