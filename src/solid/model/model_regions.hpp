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

/// Splits the cubes of a grid that fail, in regions of neighbouring ones that do not touch each other.
/// @param most_splits  of a cube. @param finer  where boxes are split though they pass: see body_cells(). @throws
/// Cancelled.
[[nodiscard]] std::vector<RefinedRegion> refine_regions(const SurfaceMesh& mesh, const CutGrid& grid, int most_splits,
                                                        std::span<const Box3> finer, const Context& context);

/// The boxes in which splitting ended. @param exponent  coordinates were multiplied by two to its power: see
/// scale_of().
[[nodiscard]] std::vector<ModelFailure> failures_of(std::span<const RefinedRegion> regions, int exponent);

}  // namespace blum::detail
