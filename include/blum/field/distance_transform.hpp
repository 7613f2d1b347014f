// Blum: exact Euclidean distance and feature transforms of voxel images. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"
#include "blum/field/field.hpp"
#include "blum/grid/label_selection.hpp"
#include "blum/grid/voxel_image.hpp"

namespace blum {

struct DistanceTransformOptions {
  LabelSelection selection = {};
  /// Signed: to the nearest voxel of the other kind, negative at selected voxels.
  /// Unsigned: to the nearest selected voxel, 0 at selected voxels.
  bool is_signed = true;
  /// Half-width of a narrow band, > 0, in the units of the image's spacing. Voxels whose distance is larger get +-band
  /// and no site. Unset: the full grid.
  std::optional<double> band = {};
};

template <>
struct Description<DistanceTransformOptions> {
  static constexpr std::string_view name = "DistanceTransformOptions";
  static constexpr std::string_view doc = "What a distance transform is asked for";
  static constexpr std::tuple members{
      Member{"selection", &DistanceTransformOptions::selection, "", "which voxels are selected"},
      Member{"signed", &DistanceTransformOptions::is_signed, "",
             "true: distance to the nearest voxel of the other kind, negative at selected voxels; false: to the "
             "nearest selected voxel"},
      Member{"band", &DistanceTransformOptions::band, "units of the spacing",
             "half-width of a narrow band; beyond it voxels get +-band and no site", Range::positive()},
  };
};

/// Exact Euclidean distance and closest voxel at every voxel of an image, from voxel centre to voxel centre, as
/// scipy.ndimage.distance_transform_edt(mask, sampling=spacing, return_indices=True) defines them.
///
/// @param image  must pass validate(image).
/// @return       a field on image.grid; site ids are linear indices of voxels (SiteIds::voxels); the sign rule is
///               `label`, or `none` when unsigned. Distances have the units of the spacing. Where the squared spacings
///               are small multiples of a common unit (all equal, say, or whole numbers), squared distances are exact
///               integers, and distances are their correctly rounded roots times that unit; else they are computed in
///               double. Among voxels at the same computed distance the smallest linear index wins. The same bytes for
///               any number of threads.
/// @throws InvalidImage (also when no voxel is selected, or, signed, when every voxel is; and when the image spans less
/// than 1e-36 or more than 1e37, which 32-bit distances do not hold), InvalidOption, OutOfMemory,
/// Cancelled.
/// Cost: about O(voxels log(side)), at worst another factor of two; 8 bytes per voxel for the result and 1/8 byte, plus
/// a few MiB per thread, beside it.
/// Method: one pass per axis (Maurer 2003; Felzenszwalb, Huttenlocher 2012); instead of lower envelopes the passes
/// along y and z use that the closest row moves monotonically along a column (Aggarwal 1987), many columns at a time.
[[nodiscard]] Field distance_transform(const VoxelImageView& image, const DistanceTransformOptions& options = {},
                                       const Context& context = {});

/// The transforms of several selections (labels, thresholds) of one image, in their order; each equals, byte for byte,
/// distance_transform with that selection. options.selection is ignored. The image is checked once and working memory
/// is shared; the results take 8 bytes per voxel and selection.
/// @throws as distance_transform.
[[nodiscard]] std::vector<Field> distance_transforms(const VoxelImageView& image,
                                                     std::span<const LabelSelection> selections,
                                                     const DistanceTransformOptions& options = {},
                                                     const Context& context = {});

}  // namespace blum
