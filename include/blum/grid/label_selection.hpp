// Blum: selection of voxels of an image. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "blum/core/describe.hpp"

namespace blum {

/// Rule that selects voxels of an image. Voxels that are NaN are never selected.
struct LabelSelection {
  enum class Rule : std::uint8_t {
    nonzero,   ///< value != 0
    label,     ///< value == label, compared exactly
    threshold  ///< value >= threshold, compared exactly
  };
  Rule rule = Rule::nonzero;
  std::int64_t label = 0;  ///< for Rule::label
  double threshold = 0;    ///< for Rule::threshold, in the units of the image's values; not NaN

  [[nodiscard]] static constexpr LabelSelection of_label(std::int64_t value) { return {Rule::label, value, 0}; }
  [[nodiscard]] static constexpr LabelSelection at_least(double value) { return {Rule::threshold, 0, value}; }
  /// Returns the selection by label or by threshold, whichever is set; Rule::nonzero if neither is set. @throws
  /// InvalidOption if both options are set.
  [[nodiscard]] static LabelSelection of(const std::optional<std::int64_t>& label,
                                         const std::optional<double>& threshold) {
    exclude_both(label.has_value(), threshold.has_value());
    if (label) return of_label(*label);
    return threshold ? at_least(*threshold) : LabelSelection{};
  }
  /// @param prefix  text before the names of the two options in messages. @throws InvalidOption if both options are
  ///                given.
  static void exclude_both(bool has_label, bool has_threshold, const std::string& prefix = {}) {
    exclude(has_label, prefix + "label", has_threshold, prefix + "threshold", "each selects the voxels");
  }
};

}  // namespace blum
