// Blum: request for a distance transform of an image. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "blum/field/distance_transform.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/label_selection.hpp"

namespace blum::detail {

/// Request for a transform, and the memory of its result. It is made once and passed on unchanged to the CPU's passes,
/// and across the border of the CUDA module to its kernels. Axes of length one are dropped, so that the others come
/// first. The struct is plain memory; cuda::module_version counts its layouts.
struct ImageRequest {
  std::size_t size[3] = {1, 1, 1};
  bool is_signed = true;

  /// Squared distances are sums of weight * (coordinate difference)^2, in units of unit^2.
  bool integer = true;          ///< Weights are whole numbers, and every sum is below 2^30.
  bool exact_in_float = false;  ///< Sums are below 2^24, the unit is a power of two: float roots are correctly rounded.
  double weight[3] = {1, 1, 1};
  double unit = 1;

  bool has_band = false;
  float band = 0;  ///< half-width, rounded to float; the distance of voxels beyond it

  LabelSelection selection = {};
  float* distance = nullptr;      ///< one per voxel, x fastest, in units of the spacing
  std::uint32_t* site = nullptr;  ///< one per voxel: linear index of the closest one; 0xffffffff beyond the band

  [[nodiscard]] std::size_t voxel_count() const { return size[0] * size[1] * size[2]; }
};
static_assert(std::is_standard_layout_v<ImageRequest> && std::is_trivially_copyable_v<ImageRequest>);

/// Returns the request for an image's grid and options, without memory yet.
/// @throws InvalidImage if the grid spans too much or too little for 32-bit distances; InvalidOption if the band is not
/// positive.
[[nodiscard]] ImageRequest make_image_request(const GridSpec& grid, const DistanceTransformOptions& options);

}  // namespace blum::detail
