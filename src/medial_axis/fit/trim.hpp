// Blum: what of an axis lies outside of its exact borders. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "blum/core/context.hpp"
#include "medial_axis/axis_lists.hpp"

namespace blum {

/// Collapses triangles and edges none of whose vertices sees two footprints at more than theta apart, from the free
/// borders inwards and as long as homotopy lets them go: the cells that an axis is made of reach up to a voxel beyond
/// where the angle is theta.
/// @param angles  that each vertex sees, degrees.  @param theta  degrees.
/// @throws Cancelled. Cost: near-linear.
void trim(AxisLists& lists, const std::vector<double>& angles, double theta, const Context& context);

}  // namespace blum
