// Blum: smooth curves from chains of voxels. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "blum/core/context.hpp"
#include "blum/medial_axis/centreline.hpp"
#include "medial_axis/centreline/curve_graph.hpp"
#include "medial_axis/centreline/prune_spurs.hpp"
#include "medial_axis/centreline/sections.hpp"

namespace blum::centrelines {

/// Computes the nodes and branches of a centreline in world units, with the centre of the box's voxel (0, 0, 0) at the
/// origin. The points of chains are smoothed and moved to the centroids of the sections across the chains, none by more
/// than a voxel. Within the balls of junctions, where sections are meaningless, branches are straight. At a free end,
/// the ball around the last point touches the tip of the label.
void place_curves(const CurveGraph& graph, const ChainMeasure& measure, const LabelShare& label, Centreline& out,
                  const Context& context);

}  // namespace blum::centrelines
