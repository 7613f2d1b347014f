// Blum: the arithmetic of distance transforms of images. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "blum/field/distance_transform.hpp"
#include "blum/grid/grid_spec.hpp"

namespace blum::detail {

/// What a transform computes, on whatever device. Axes of length one are dropped, so that the others come first.
struct ImagePlan {
  std::size_t size[3] = {1, 1, 1};
  bool is_signed = true;

  /// Squared distances are sums of weight * (coordinate difference)^2, in units of unit^2.
  bool integer = true;          ///< weights are whole numbers, and every sum is below 2^30
  bool exact_in_float = false;  ///< all sums are below 2^24 and the unit is a power of two: float roots are right
  double weight[3] = {1, 1, 1};
  double unit = 1;

  bool has_band = false;
  float band = 0;  ///< largest float that is not above the half-width; what voxels beyond it get

  [[nodiscard]] std::size_t voxel_count() const { return size[0] * size[1] * size[2]; }
};

/// @throws InvalidImage where the grid spans too much or too little for 32-bit distances; InvalidOption.
[[nodiscard]] ImagePlan make_image_plan(const GridSpec& grid, const DistanceTransformOptions& options);

}  // namespace blum::detail
