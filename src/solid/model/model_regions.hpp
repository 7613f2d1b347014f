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

/// Splits the cubes of a grid that fail. Returns regions of neighbouring cubes. Different regions do not touch each
/// other.
/// @param most_splits  limit on successive cuts of each cube.
/// @param finer  regions in which boxes are split even if they pass: see body_cells().
/// @throws Cancelled.
[[nodiscard]] std::vector<RefinedRegion> refine_regions(const SurfaceMesh& mesh, const CutGrid& grid, int most_splits,
                                                        std::span<const Box3> finer, const Context& context);

/// Returns the boxes that fail and could not be split further.
/// @param exponent  the mesh was multiplied by 2^exponent, which is undone here: see scale_of().
[[nodiscard]] std::vector<ModelFailure> failures_of(std::span<const RefinedRegion> regions, int exponent);

}  // namespace blum::detail
