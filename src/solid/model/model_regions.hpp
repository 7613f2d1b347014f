// Blum: the regions of a grid that are split. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/solid/cellular_model.hpp"
#include "solid/model/cut_grid.hpp"
#include "solid/model/refined_region.hpp"
#include "solid/model/surface_mesh.hpp"

namespace blum::detail {

/// Splits the cubes of a grid that fail. Returns regions of neighbouring cubes, which do not touch each other.
/// @param most_splits  limit for each cube.
/// @param finer  boxes in which boxes are split even if they pass: see body_cells().
/// @throws Cancelled.
[[nodiscard]] std::vector<RefinedRegion> refine_regions(const SurfaceMesh& mesh, const CutGrid& grid, int most_splits,
                                                        std::span<const Box3> finer, const Context& context);

/// Returns the boxes in which splitting ended without success.
/// @param exponent  coordinates were multiplied by two to its power: see scale_of().
[[nodiscard]] std::vector<ModelFailure> failures_of(std::span<const RefinedRegion> regions, int exponent);

}  // namespace blum::detail
