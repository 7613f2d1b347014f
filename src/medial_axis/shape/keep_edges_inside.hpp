// Blum: edges of the axis of an image that would cross gaps. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "medial_axis/shape/axis_corners.hpp"
#include "medial_axis/shape/axis_piece.hpp"
#include "medial_axis/surface/governors.hpp"

namespace blum {

/// Two ends of an edge may have moved from their lattice corners into parts of an image that have a gap between them,
/// as the tips of a U have. Such ends go back to their corners, whose edges lie in the solid: on its surface, where
/// their radius is 0. Edges that only cut a corner of the solid stay.
void keep_edges_inside(AxisPiece& piece, const AxisCorners& corners, const GovernorField& governors,
                       const Context& context);

}  // namespace blum
