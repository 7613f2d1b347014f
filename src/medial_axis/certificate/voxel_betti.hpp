// Blum: components, tunnels and voids of voxels, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "blum/grid/voxel_set.hpp"
#include "blum/medial_axis/certificate.hpp"

namespace blum::verifier {

/// Betti numbers of the union of closed voxels: components by flooding over corners, voids by flooding the rest over
/// faces, and tunnels from the number of cells. @throws Cancelled. Memory: two more sets.
[[nodiscard]] BettiNumbers voxel_betti_numbers(const VoxelSet& voxels, const Context& context);

}  // namespace blum::verifier
