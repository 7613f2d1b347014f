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
  /// True: a selected voxel gets minus the distance to the nearest voxel that is not selected. Any other voxel gets the
  /// distance to the nearest selected voxel. False: each voxel gets the distance to the nearest selected voxel, which
  /// is 0 at selected voxels.
  bool is_signed = true;
  /// Largest distance that is computed (half-width of the band), > 0, in the units of the image's spacing. Voxels with
  /// a larger distance get +-band and no site. Unset: no limit.
  std::optional<double> band = {};
  /// True: the field contains the closest voxel of every voxel. False: the field contains no sites, and takes half the
  /// memory during and after the computation. The distances do not depend on this option.
  bool sites = true;
};

template <>
struct Description<DistanceTransformOptions> {
  static constexpr std::string_view name = "DistanceTransformOptions";
  static constexpr std::string_view doc = "Options of a distance transform";
  static constexpr std::tuple members{
      Member{"selection", &DistanceTransformOptions::selection, "", "selected voxels"},
      Member{"signed", &DistanceTransformOptions::is_signed, "",
             "true: distance to the nearest voxel of the other kind (selected or not), negative at selected voxels; "
             "false: distance to the nearest selected voxel"},
      Member{"band", &DistanceTransformOptions::band, "units of the spacing",
             "half-width of a band around the selected voxels; voxels beyond it get the distance +-band and no site",
             Range::positive()},
      Member{"sites", &DistanceTransformOptions::sites, "", "true: store the closest voxels, which doubles the memory"},
  };
};

/// Computes the exact Euclidean distance and the closest voxel for every voxel of an image. Distances are measured
/// between voxel centres. The definition is that of scipy.ndimage.distance_transform_edt(mask, sampling=spacing,
/// return_indices=True).
///
/// @param image  must pass validate(image).
/// @return       a field on image.grid. Site ids are linear indices of voxels (SiteIds::voxels). The sign rule is
///               `label`, or `none` if unsigned. Distances are in the units of the spacing. If the squared spacings are
///               small multiples of a common unit (for example all equal, or whole numbers), squared distances are
///               computed exactly, as integers. Distances are then the correctly rounded square roots, in the units of
///               the spacing. Otherwise, distances are computed in double. If several voxels have the smallest computed
///               distance, the one with the smallest linear index is reported. The bytes are the same for any number of
///               threads.
/// @throws InvalidImage, also if no voxel is selected, or if every voxel is selected in a signed transform.
/// @throws InvalidImage if the image spans less than 1e-36 or more than 1e37, which 32-bit distances cannot represent.
/// @throws InvalidOption, OutOfMemory, DeviceError, Cancelled.
/// Cost: about O(voxels log(side)) for `side` voxels along the longest side. The worst case takes twice the usual time.
/// The result takes 8 bytes per voxel, or 4 without sites. The working memory takes 1/8 byte per voxel, and a few MiB
/// per thread. Method: one pass per axis (Maurer 2003; Felzenszwalb, Huttenlocher 2012). The passes along y and z use
/// no lower envelopes. Instead, these passes rely on the fact that the index of the closest row is monotone along a
/// column (Aggarwal 1987). The passes along y and z process many columns at a time.
[[nodiscard]] Field distance_transform(const VoxelImageView& image, const DistanceTransformOptions& options = {},
                                       const Context& context = {});

/// Computes the transforms of several selections (labels, thresholds) of one image, in their order. Each result equals
/// that of distance_transform() with one selection, byte for byte. options.selection is ignored. The image is checked
/// once, and working memory is shared. The results take 8 bytes per voxel and selection, or 4 without
/// sites.
/// @throws as distance_transform().
[[nodiscard]] std::vector<Field> distance_transforms(const VoxelImageView& image,
                                                     std::span<const LabelSelection> selections,
                                                     const DistanceTransformOptions& options = {},
                                                     const Context& context = {});

}  // namespace blum
