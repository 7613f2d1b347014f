// Blum: smooth curves from chains of voxels. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "blum/core/context.hpp"
#include "blum/medial_axis/centreline.hpp"
#include "medial_axis/centreline/curve_graph.hpp"
#include "medial_axis/centreline/prune_spurs.hpp"
#include "medial_axis/centreline/sections.hpp"

namespace blum::centrelines {

/// Puts nodes and branches into a centreline, in units of the world, with voxel (0, 0, 0) of the box at the origin.
/// Chains are moved to the centroids of the sections across them, no point by more than a voxel, and smoothed. Within
/// the balls of junctions, where sections are meaningless, they are straight. Free ends lie where their ball touches
/// the tip of the label.
void place_curves(const CurveGraph& graph, const ChainMeasure& measure, const LabelShare& label, Centreline& out,
                  const Context& context);

}  // namespace blum::centrelines
