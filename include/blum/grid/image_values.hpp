// Blum: values of an image. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/betti_numbers.hpp"
#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/warning.hpp"
#include "blum/grid/label_selection.hpp"
#include "blum/grid/voxel_image.hpp"

namespace blum {

/// Voxels of one value.
struct LabelFacts {
  std::int64_t label = 0;
  std::uint64_t voxels = 0;
  double volume = 0;                       ///< volume of all these voxels together, in cubic units of the spacing
  std::optional<BettiNumbers> betti = {};  ///< Betti numbers of the union of these voxels as closed boxes; unset for 0,
                                           ///< the background
};

template <>
struct Description<LabelFacts> {
  static constexpr std::string_view name = "LabelFacts";
  static constexpr std::string_view doc = "Voxels of one value of an image";
  static constexpr std::tuple members{
      Member{"label", &LabelFacts::label, "", "value of the voxels"},
      Member{"voxels", &LabelFacts::voxels, "", "number of voxels"},
      Member{"volume", &LabelFacts::volume, "cubic units of the spacing", "total volume"},
      Member{"betti", &LabelFacts::betti, "",
             "components, tunnels, voids of the union of the voxels; unknown for 0, the background"},
  };
};

/// Values of an image.
struct ImageValues {
  std::optional<std::array<double, 2>> range = {};  ///< smallest and largest value; unset if all voxels are NaN
  std::uint64_t nonzero = 0;                        ///< number of voxels that are neither 0 nor NaN
  std::uint64_t not_numbers = 0;                    ///< number of voxels that are NaN
  /// Number of distinct values. Unset if there are more than 100,000 distinct values, or if a value cannot be a label.
  /// Labels are whole numbers that fit int64. In images of floating-point numbers, labels must be at most 2^53.
  std::optional<std::uint64_t> distinct = {};
  std::vector<LabelFacts> labels = {};  ///< the most frequent values, in falling order of their number of voxels; empty
                                        ///< if `distinct` is unset
};

template <>
struct Description<ImageValues> {
  static constexpr std::string_view name = "ImageValues";
  static constexpr std::string_view doc = "Values of an image";
  static constexpr std::tuple members{
      Member{"range", &ImageValues::range, "", "smallest and largest value; unknown if all voxels are NaN"},
      Member{"nonzero", &ImageValues::nonzero, "", "number of voxels that are neither 0 nor NaN"},
      Member{"not_numbers", &ImageValues::not_numbers, "", "number of voxels that are NaN"},
      Member{"distinct", &ImageValues::distinct, "",
             "number of distinct values; unknown if the values cannot be labels"},
      Member{"labels", &ImageValues::labels, "", "voxels of each value, most frequent value first"},
  };
};

/// Returns the values of an image.
/// @param image        must pass validate(image).
/// @param most_labels  largest length of `labels`. Other labels are only counted in `distinct`.
/// @throws Cancelled.
/// Cost: one pass over the values, plus selected_voxels() and betti_numbers() for each listed label. For 256^3 voxels,
/// this takes about 10 ms per label.
[[nodiscard]] ImageValues image_values(const VoxelImageView& image, std::size_t most_labels = 20,
                                       const Context& context = {});

/// Largest distance of a value from a whole number at which the value still counts as a label. A scale factor in single
/// precision, as in NIfTI files, changes labels up to 65,535 by less than this tolerance.
inline constexpr double label_tolerance = 0.01;

/// Values of an image of labels, rounded to whole numbers.
struct RoundedLabels {
  VoxelImage::Values values;  ///< of the same type as those of the image
  Warning warning;            ///< WarningCode::rounded
};

/// Rounds the values of an image to labels, if rounding is necessary and safe. Rounding is necessary if values are not
/// whole numbers. Rounding is safe if all values are within label_tolerance of whole numbers of at most 2^53. NaN stays
/// NaN. Functions that select a label compare exactly, so pass them an image with the rounded values.
/// @param image   must pass validate(image).
/// @param labels  requested labels; if empty, all labels are requested.
/// @return        nullopt if no value has to be rounded, or if rounding is not safe.
/// @throws InvalidImage if rounding is not safe, and the value of a voxel is close to a requested label, but not equal
/// to it. Selecting voxels whose value nearly equals a label would be a guess.
/// @throws Cancelled.
/// Cost: one pass over images of floating-point numbers. Other images cost nothing.
[[nodiscard]] std::optional<RoundedLabels> rounded_labels(const VoxelImageView& image,
                                                          std::span<const std::int64_t> labels = {},
                                                          const Context& context = {});

/// Returns a message that no voxel is selected. The message lists the values that the image contains.
[[nodiscard]] std::string nothing_selected_text(const VoxelImageView& image, const LabelSelection& selection);

}  // namespace blum
