#include "blum/grid/selected_voxels.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstring>
#include <span>
#include <variant>

#include "blum/core/parallel.hpp"
#include "blum/grid/voxel_test.hpp"

namespace blum {
namespace detail {
namespace {

/// Packs 64 bytes, each 0 or 1, into a 64-bit word: byte i becomes bit i.
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

  // A task is a part of one row, or several whole rows. It has about 2^20 voxels, few enough to react quickly to a
  // cancel.
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
            make_voxel_test<T>(selection));
      },
      image.values);
  return selected;
}

}  // namespace detail

VoxelSet selected_voxels(const VoxelImageView& image, const LabelSelection& selection, const Context& context) {
  validate(image);
  detail::MaskBits mask;
  const auto& size = image.grid.size;
  static_cast<void>(detail::select_voxels(image, selection, static_cast<std::size_t>(size[0]), context, mask));
  VoxelSet voxels(size);
  std::size_t first = 0;
  for (std::int64_t k = 0; k < size[2]; ++k) {
    for (std::int64_t j = 0; j < size[1]; ++j, first += mask.words_per_row) {
      const auto row = mask.words.span().subspan(first, mask.words_per_row);
      std::copy(row.begin(), row.end(), voxels.row(j, k).begin());
    }
  }
  return voxels;
}

}  // namespace blum
