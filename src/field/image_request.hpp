// Blum: request for a distance transform of an image. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "blum/field/distance_transform.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/label_selection.hpp"

namespace blum::detail {

/// Request for a transform, and the memory of its result. The request is created once, and passed unchanged to the
/// CPU's passes, or to the CUDA module and its kernels. Axes of length one are removed, and the remaining axes move
/// forward. The struct must be plain data; cuda::module_version must change with its layout.
struct ImageRequest {
  std::size_t size[3] = {1, 1, 1};
  bool is_signed = true;

  /// A squared distance is the sum of weight * (coordinate difference)^2 over the axes, in units of unit^2.
  bool integer = true;  ///< True if the weights are integers and every sum is below 2^30.
  /// True if sums are below 2^24 and the unit is a power of two. In this case, float roots are correctly rounded.
  bool exact_in_float = false;
  double weight[3] = {1, 1, 1};
  double unit = 1;

  bool has_band = false;
  float band = 0;  ///< half-width, rounded to float; also the distance written for voxels beyond it

  LabelSelection selection = {};
  float* distance = nullptr;  ///< one per voxel, x fastest, in the unit of the spacing
  /// One per voxel: linear index of the closest site voxel; 0xffffffff beyond the band. Null if no sites are requested.
  std::uint32_t* site = nullptr;

  [[nodiscard]] std::size_t voxel_count() const { return size[0] * size[1] * size[2]; }
};
static_assert(std::is_standard_layout_v<ImageRequest> && std::is_trivially_copyable_v<ImageRequest>);

/// Returns the request for an image's grid and options. The request's result memory is not set yet.
/// @throws InvalidImage if the grid is too large or too small for 32-bit distances; InvalidOption if the band is not
/// positive.
[[nodiscard]] ImageRequest make_image_request(const GridSpec& grid, const DistanceTransformOptions& options);

}  // namespace blum::detail
