// Blum: voxel images. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "blum/grid/grid_spec.hpp"

namespace blum {

/// View of a 3D image through a span. The view copies and owns no values. See VoxelImage.
struct VoxelImageView {
  /// Types in the order of VoxelImage::Values.
  using Values =
      std::variant<std::span<const std::uint8_t>, std::span<const std::int8_t>, std::span<const std::uint16_t>,
                   std::span<const std::int16_t>, std::span<const std::uint32_t>, std::span<const std::int32_t>,
                   std::span<const std::uint64_t>, std::span<const std::int64_t>, std::span<const float>,
                   std::span<const double>>;
  GridSpec grid;
  Values values;  ///< grid.node_count() values
  std::string space = {};
};

/// 3D image: one value per voxel, x fastest, and the positions of the voxel centres in the world. The grid's nodes are
/// the voxel centres. The world axes are those of the source file, without conversion (NRRD and ITK: LPS; NIfTI: RAS).
struct VoxelImage {
  using Values =
      std::variant<std::vector<std::uint8_t>, std::vector<std::int8_t>, std::vector<std::uint16_t>,
                   std::vector<std::int16_t>, std::vector<std::uint32_t>, std::vector<std::int32_t>,
                   std::vector<std::uint64_t>, std::vector<std::int64_t>, std::vector<float>, std::vector<double>>;
  GridSpec grid;
  Values values;  ///< grid.node_count() values
  /// Meaning of the world axes, with the names of NRRD ("left-posterior-superior", "right-anterior-superior",
  /// "scanner-xyz", ...). Empty if the file does not state it.
  std::string space = {};

  [[nodiscard]] VoxelImageView view() const {
    return {grid, std::visit([](const auto& v) { return VoxelImageView::Values(std::span(v)); }, values), space};
  }
  operator VoxelImageView() const { return view(); }  // NOLINT(google-explicit-constructor): an image is its view
};

/// @throws InvalidImage unless the grid is valid, has at most max_id_count voxels, and values has one entry per voxel.
void validate(const VoxelImageView& image);

}  // namespace blum
