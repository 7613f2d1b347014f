#include "field/cpu/distance_transform_mask.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>

#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"

namespace blum::detail {
namespace {

// A selection in terms of the image's own value type: tests that are a single comparison, so that they vectorise.
struct Never {
  template <class T>
  bool operator()(T) const {
    return false;
  }
};
struct Always {
  template <class T>
  bool operator()(T) const {
    return true;
  }
};
template <class T>
struct Nonzero {
  // Written so that NaN is not selected.
  bool operator()(T value) const {
    if constexpr (std::is_floating_point_v<T>) return (value < T(0)) | (value > T(0));
    return value != T(0);
  }
};
template <class T>
struct Equal {
  T label;
  bool operator()(T value) const { return value == label; }
};
template <class T>
struct AtLeast {
  T lowest;
  bool operator()(T value) const { return value >= lowest; }
};

template <class T>
using Test = std::variant<Never, Always, Nonzero<T>, Equal<T>, AtLeast<T>>;

template <class T>
Test<T> label_test(std::int64_t label) {
  if constexpr (std::is_floating_point_v<T>) {
    // A label that the type cannot hold exactly is equal to none of its values. (2^63 itself is out of int64's range.)
    const T nearest = static_cast<T>(label);
    if (nearest >= T(9223372036854775808.0) || static_cast<std::int64_t>(nearest) != label) return Never{};
    return Equal<T>{nearest};
  } else {
    if (!std::in_range<T>(label)) return Never{};
    return Equal<T>{static_cast<T>(label)};
  }
}

template <class T>
Test<T> threshold_test(double threshold) {
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
    // As doubles the limits may round up to the next power of two, which no value of the type reaches.
    if (lowest <= static_cast<double>(std::numeric_limits<T>::min())) return Always{};
    if (lowest >= std::ldexp(1.0, std::numeric_limits<T>::digits)) return Never{};
    return AtLeast<T>{static_cast<T>(lowest)};
  }
}

template <class T>
Test<T> make_test(const LabelSelection& selection) {
  switch (selection.rule) {
    case LabelSelection::Rule::nonzero:
      return Nonzero<T>{};
    case LabelSelection::Rule::label:
      return label_test<T>(selection.label);
    case LabelSelection::Rule::threshold:
      if (std::isnan(selection.threshold)) throw InvalidOption("the threshold is not a number; give a number");
      return threshold_test<T>(selection.threshold);
  }
  throw InvalidOption("unknown selection rule " + std::to_string(static_cast<int>(selection.rule)));
}

/// Packs 64 bytes of 0 or 1 into one word, byte i into bit i.
std::uint64_t pack(const std::uint8_t* flags) {
  std::uint64_t word = 0;
  for (unsigned byte = 0; byte < 8; ++byte) {
    std::uint64_t eight = 0;
    if constexpr (std::endian::native == std::endian::little) {
      std::memcpy(&eight, flags + 8 * byte, 8);
      // Byte i of `eight` moves to bit 56 + i; the partial products never carry into each other.
      eight = (eight * 0x0102040810204080ULL) >> 56U;
    } else {
      for (unsigned i = 0; i < 8; ++i) eight |= std::uint64_t{flags[8 * byte + i]} << i;
    }
    word |= eight << (8 * byte);
  }
  return word;
}

template <class T, class Predicate>
std::size_t select_row(const T* values, std::size_t length, const Predicate& test, std::uint64_t* words) {
  std::size_t count = 0;
  std::array<std::uint8_t, 64> flags{};
  for (std::size_t begin = 0; begin < length; begin += 64) {
    if (length - begin >= 64) {
      for (std::size_t i = 0; i < 64; ++i) flags[i] = static_cast<std::uint8_t>(test(values[begin + i]));
    } else {
      flags.fill(0);
      for (std::size_t i = 0; i < length - begin; ++i) flags[i] = static_cast<std::uint8_t>(test(values[begin + i]));
    }
    const std::uint64_t word = pack(flags.data());
    count += static_cast<std::size_t>(std::popcount(word));
    words[begin / 64] = word;
  }
  return count;
}

}  // namespace

std::size_t select_voxels(const VoxelImageView& image, const LabelSelection& selection, std::size_t row_length,
                          const Context& context, MaskBits& mask) {
  const std::size_t rows = image.grid.node_count() / row_length;
  mask.words_per_row = (row_length + 63) / 64;
  if (mask.words.size() != rows * mask.words_per_row) mask.words = Buffer<std::uint64_t>(rows * mask.words_per_row);

  // A task is a stretch of one row or several whole rows: about 2^20 voxels, few enough to stop quickly.
  constexpr std::size_t task_voxels = std::size_t{1} << 20U;
  const std::size_t stretch = std::min(row_length, task_voxels);
  const std::size_t stretches = (row_length + stretch - 1) / stretch;
  const std::size_t grain = std::max<std::size_t>(1, task_voxels / stretch);
  std::atomic<std::size_t> selected{0};
  std::visit(
      [&]<class T>(const std::span<const T>& values) {
        std::visit(
            [&](const auto& test) {
              parallel_for(context, rows * stretches, grain, "select voxels", [&](const WorkRange& range) {
                std::size_t count = 0;
                for (std::size_t item = range.begin; item < range.end; ++item) {
                  const std::size_t row = item / stretches;
                  const std::size_t begin = item % stretches * stretch;
                  count += select_row(values.data() + row * row_length + begin, std::min(stretch, row_length - begin),
                                      test, mask.words.data() + row * mask.words_per_row + begin / 64);
                }
                selected += count;
              });
            },
            make_test<T>(selection));
      },
      image.values);
  return selected;
}

}  // namespace blum::detail
