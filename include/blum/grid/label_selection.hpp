// Blum: which voxels of an image are meant. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace blum {

/// Which voxels of an image are selected. Voxels that are not a number never are.
struct LabelSelection {
  enum class Rule : std::uint8_t {
    nonzero,   ///< value != 0
    label,     ///< value == label, compared exactly
    threshold  ///< value >= threshold, compared exactly
  };
  Rule rule = Rule::nonzero;
  std::int64_t label = 0;  ///< for Rule::label
  double threshold = 0;    ///< for Rule::threshold, in image values; not NaN

  [[nodiscard]] static constexpr LabelSelection of_label(std::int64_t value) { return {Rule::label, value, 0}; }
  [[nodiscard]] static constexpr LabelSelection at_least(double value) { return {Rule::threshold, 0, value}; }
};

}  // namespace blum
