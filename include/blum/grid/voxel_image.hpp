// Blum: voxel images. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "blum/grid/grid_spec.hpp"

namespace blum {

/// A 3D image: one value per voxel, x fastest, and where its voxel centres lie in the world.
/// The grid's nodes are the voxel centres. World axes are those of the file that it came from (NRRD and ITK: LPS;
/// NIfTI: RAS), which is not converted.
struct VoxelImage {
  using Values =
      std::variant<std::vector<std::uint8_t>, std::vector<std::int8_t>, std::vector<std::uint16_t>,
                   std::vector<std::int16_t>, std::vector<std::uint32_t>, std::vector<std::int32_t>,
                   std::vector<std::uint64_t>, std::vector<std::int64_t>, std::vector<float>, std::vector<double>>;
  GridSpec grid;
  Values values;  ///< grid.node_count() values
  /// What the world axes are, as NRRD names it ("left-posterior-superior", "right-anterior-superior", "scanner-xyz",
  /// ...); empty where the file does not say.
  std::string space = {};
};

/// @throws InvalidImage unless the grid is valid, holds at most max_id_count voxels and values has one entry per voxel.
void validate(const VoxelImage& image);

}  // namespace blum
