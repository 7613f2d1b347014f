// Blum: tests of single values of an image. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "blum/core/error.hpp"
#include "blum/grid/label_selection.hpp"

namespace blum::detail {

// Each test is a single comparison, so that loops over it vectorise. Tests are constexpr because device kernels call
// them, too.
struct NoVoxel {
  template <class T>
  constexpr bool operator()(T) const {
    return false;
  }
};
struct EveryVoxel {
  template <class T>
  constexpr bool operator()(T) const {
    return true;
  }
};
template <class T>
struct Nonzero {
  // Written so that NaN is not selected.
  constexpr bool operator()(T value) const {
    if constexpr (std::is_floating_point_v<T>) return (value < T(0)) | (value > T(0));
    return value != T(0);
  }
};
template <class T>
struct Equal {
  T label;
  constexpr bool operator()(T value) const { return value == label; }
};
template <class T>
struct AtLeast {
  T lowest;
  constexpr bool operator()(T value) const { return value >= lowest; }
};

template <class T>
using VoxelTest = std::variant<NoVoxel, EveryVoxel, Nonzero<T>, Equal<T>, AtLeast<T>>;

/// Returns the test for a label in the image's own value type.
template <class T>
VoxelTest<T> label_test(std::int64_t label) {
  if constexpr (std::is_floating_point_v<T>) {
    // If the type cannot represent a label exactly, no value equals the label. (2^63 is out of the range of int64.)
    const T nearest = static_cast<T>(label);
    if (nearest >= T(9223372036854775808.0) || static_cast<std::int64_t>(nearest) != label) return NoVoxel{};
    return Equal<T>{nearest};
  } else {
    if (!std::in_range<T>(label)) return NoVoxel{};
    return Equal<T>{static_cast<T>(label)};
  }
}

template <class T>
VoxelTest<T> threshold_test(double threshold) {
  if constexpr (std::is_floating_point_v<T>) {
    using Limits = std::numeric_limits<T>;
    if (threshold > static_cast<double>(Limits::max())) return AtLeast<T>{Limits::infinity()};
    if (std::isinf(threshold)) return AtLeast<T>{-Limits::infinity()};
    if (threshold < static_cast<double>(Limits::lowest())) return AtLeast<T>{Limits::lowest()};
    T lowest = static_cast<T>(threshold);
    if (static_cast<double>(lowest) < threshold) lowest = std::nextafter(lowest, Limits::infinity());
    return AtLeast<T>{lowest};
  } else {
    const double lowest = std::ceil(threshold);
    // Converted to double, the upper limit may be rounded to the next power of two, which no value of the type reaches.
    if (lowest <= static_cast<double>(std::numeric_limits<T>::min())) return EveryVoxel{};
    if (lowest >= std::ldexp(1.0, std::numeric_limits<T>::digits)) return NoVoxel{};
    return AtLeast<T>{static_cast<T>(lowest)};
  }
}

/// Returns the test for a selection, in the image's own value type. @throws InvalidOption if the threshold is NaN.
template <class T>
VoxelTest<T> make_voxel_test(const LabelSelection& selection) {
  switch (selection.rule) {
    case LabelSelection::Rule::nonzero:
      return Nonzero<T>{};
    case LabelSelection::Rule::label:
      return label_test<T>(selection.label);
    case LabelSelection::Rule::threshold:
      if (std::isnan(selection.threshold)) throw InvalidOption("the threshold is NaN, but must be a number");
      return threshold_test<T>(selection.threshold);
  }
  throw InvalidOption("unknown selection rule " + std::to_string(static_cast<int>(selection.rule)));
}

}  // namespace blum::detail
