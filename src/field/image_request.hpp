// Blum: what a distance transform of an image is asked for. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "blum/field/distance_transform.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/label_selection.hpp"

namespace blum::detail {

/// What a transform computes, and where that goes: made once, and passed on as it is to the CPU's passes, across the
/// border of the CUDA module and to its kernels. Axes of length one are dropped, so that the others come first. Plain
/// memory: cuda::module_version counts its layouts.
struct ImageRequest {
  std::size_t size[3] = {1, 1, 1};
  bool is_signed = true;

  /// Squared distances are sums of weight * (coordinate difference)^2, in units of unit^2.
  bool integer = true;          ///< weights are whole numbers, and every sum is below 2^30
  bool exact_in_float = false;  ///< all sums are below 2^24 and the unit is a power of two: float roots are right
  double weight[3] = {1, 1, 1};
  double unit = 1;

  bool has_band = false;
  float band = 0;  ///< largest float that is not above the half-width; what voxels beyond it get

  LabelSelection selection = {};
  float* distance = nullptr;      ///< one per voxel, x fastest, in units of the spacing
  std::uint32_t* site = nullptr;  ///< one per voxel: the closest one's linear index; 0xffffffff beyond the band

  [[nodiscard]] std::size_t voxel_count() const { return size[0] * size[1] * size[2]; }
};
static_assert(std::is_standard_layout_v<ImageRequest> && std::is_trivially_copyable_v<ImageRequest>);

/// The request of an image's grid and its options; without memory yet.
/// @throws InvalidImage where the grid spans too much or too little for 32-bit distances; InvalidOption.
[[nodiscard]] ImageRequest make_image_request(const GridSpec& grid, const DistanceTransformOptions& options);

}  // namespace blum::detail
