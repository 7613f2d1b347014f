// Blum: which values an image holds. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/betti_numbers.hpp"
#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/grid/label_selection.hpp"
#include "blum/grid/voxel_image.hpp"

namespace blum {

/// The voxels of one value.
struct LabelFacts {
  std::int64_t label = 0;
  std::uint64_t voxels = 0;
  double volume = 0;                       ///< of the voxels, in cubic units of the spacing
  std::optional<BettiNumbers> betti = {};  ///< of the union of the closed voxels; unset for 0, which is background
};

template <>
struct Description<LabelFacts> {
  static constexpr std::string_view name = "LabelFacts";
  static constexpr std::string_view doc = "The voxels of one value of an image";
  static constexpr std::tuple members{
      Member{"label", &LabelFacts::label, "", "their value"},
      Member{"voxels", &LabelFacts::voxels, "", "how many there are"},
      Member{"volume", &LabelFacts::volume, "cubic units of the spacing", "of all of them"},
      Member{"betti", &LabelFacts::betti, "",
             "components, tunnels, voids of their union; unknown for 0, the background"},
  };
};

/// Which values an image holds.
struct ImageValues {
  std::optional<std::array<double, 2>> range = {};  ///< smallest and largest; unset where there are no numbers
  std::uint64_t nonzero = 0;                        ///< voxels that are not 0, nor NaN
  std::uint64_t not_numbers = 0;                    ///< voxels that are NaN
  /// Distinct values; unset where one cannot be a label (it is no whole number), or there are over 100,000.
  std::optional<std::uint64_t> distinct = {};
  std::vector<LabelFacts> labels = {};  ///< those of most voxels, the most first; none where `distinct` is unset
};

template <>
struct Description<ImageValues> {
  static constexpr std::string_view name = "ImageValues";
  static constexpr std::string_view doc = "Which values an image holds";
  static constexpr std::tuple members{
      Member{"range", &ImageValues::range, "", "smallest and largest; unknown where there are no numbers"},
      Member{"nonzero", &ImageValues::nonzero, "", "voxels that are not 0, nor NaN"},
      Member{"not_numbers", &ImageValues::not_numbers, "", "voxels that are NaN"},
      Member{"distinct", &ImageValues::distinct, "", "distinct values; unknown where they cannot be labels"},
      Member{"labels", &ImageValues::labels, "", "the voxels of each value, the most first"},
  };
};

/// @param image  must pass validate(image).  @param most_labels  those beyond are counted only.
/// @throws Cancelled. Cost: one pass over the values, and for each label what selected_voxels() and betti_numbers()
/// take; about 10 ms for each of 256^3 voxels.
[[nodiscard]] ImageValues image_values(const VoxelImageView& image, std::size_t most_labels = 20,
                                       const Context& context = {});

/// Says that no voxel is selected, and what there is instead.
[[nodiscard]] std::string nothing_selected_text(const VoxelImageView& image, const LabelSelection& selection);

}  // namespace blum
