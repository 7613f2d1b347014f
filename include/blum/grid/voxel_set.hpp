// Blum: sets of voxels. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace blum {

/// Set of voxels of a box, one bit each. Voxels beyond the box are not in the set. Rows are along x. Each row is padded
/// to whole words, with at least one bit that is always zero.
class VoxelSet {
 public:
  VoxelSet() = default;
  /// Makes the empty set. @param size  numbers of voxels along x, y, z, each >= 0.
  explicit VoxelSet(const std::array<std::int64_t, 3>& size)
      : size_(size),
        words_per_row_(static_cast<std::size_t>(size[0] / 64 + 1)),
        words_(words_per_row_ * static_cast<std::size_t>(size[1] * size[2]), 0) {}

  [[nodiscard]] const std::array<std::int64_t, 3>& size() const { return size_; }
  [[nodiscard]] std::size_t words_per_row() const { return words_per_row_; }

  /// Returns the indices (i, j, k) of a voxel from its linear index, x fastest. Divisions are in 32 bits, which is
  /// several times faster than in 64 bits.
  [[nodiscard]] std::array<std::int64_t, 3> place(std::uint32_t voxel) const {
    const auto x = static_cast<std::uint32_t>(size_[0]);
    const auto y = static_cast<std::uint32_t>(size_[1]);
    const std::uint32_t row = voxel / x;
    return {voxel - row * x, row % y, row / y};
  }

  /// Returns the linear index of a voxel of the box, x fastest.
  [[nodiscard]] std::uint32_t index(const std::array<std::int64_t, 3>& at) const {
    return static_cast<std::uint32_t>((at[2] * size_[1] + at[1]) * size_[0] + at[0]);
  }

  /// Returns true if a voxel is in the set. All indices are allowed.
  [[nodiscard]] bool contains(std::int64_t i, std::int64_t j, std::int64_t k) const {
    if (i < 0 || j < 0 || k < 0 || i >= size_[0] || j >= size_[1] || k >= size_[2]) return false;
    return (words_[word(i, j, k)] >> (i % 64) & 1U) != 0;
  }
  /// Adds a voxel. In insert() and erase(), the voxel must be in the box.
  void insert(std::int64_t i, std::int64_t j, std::int64_t k) { words_[word(i, j, k)] |= std::uint64_t{1} << (i % 64); }
  void erase(std::int64_t i, std::int64_t j, std::int64_t k) {
    words_[word(i, j, k)] &= ~(std::uint64_t{1} << (i % 64));
  }

  /// Returns the words of row (j, k). Bit i % 64 of word i / 64 is voxel (i, j, k). Bits beyond the box must remain
  /// zero.
  [[nodiscard]] std::span<std::uint64_t> row(std::int64_t j, std::int64_t k) {
    return {words_.data() + word(0, j, k), words_per_row_};
  }
  [[nodiscard]] std::span<const std::uint64_t> row(std::int64_t j, std::int64_t k) const {
    return {words_.data() + word(0, j, k), words_per_row_};
  }

  [[nodiscard]] std::size_t count() const {
    std::size_t total = 0;
    for (const std::uint64_t w : words_) total += static_cast<std::size_t>(std::popcount(w));
    return total;
  }
  [[nodiscard]] friend bool operator==(const VoxelSet&, const VoxelSet&) = default;

 private:
  [[nodiscard]] std::size_t word(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return static_cast<std::size_t>(k * size_[1] + j) * words_per_row_ + static_cast<std::size_t>(i / 64);
  }

  std::array<std::int64_t, 3> size_{0, 0, 0};
  std::size_t words_per_row_ = 0;
  std::vector<std::uint64_t> words_;
};

/// Smallest box that contains all voxels of a set. The upper corner is exclusive, and is (0, 0, 0) if the set is empty.
struct VoxelExtent {
  std::array<std::int64_t, 3> lower{};
  std::array<std::int64_t, 3> upper{};
};

/// Returns the extent of a set. Cost: linear time in the words of its rows.
[[nodiscard]] VoxelExtent extent_of(const VoxelSet& voxels);

}  // namespace blum
