// Blum: lists of candidate sites for tiles and their subdivisions. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstring>
#include <vector>

#include "blum/core/radix_sort.hpp"
#include "field/cpu/tile_kernel.hpp"

namespace blum::cpu {

/// Records of one kind that may be closest somewhere in a box. Records are in ascending order of site id, so that ties
/// go to the smaller id. After finish(), whole vectors may be read past the end.
class RecordList {
 public:
  static constexpr std::size_t padding = 16;

  /// Empties the list and makes room for `capacity` records.
  void reset(std::size_t capacity) {
    if (records_.size() < capacity + padding) records_ = Buffer<Record>(capacity + capacity / 2 + 4 * padding);
    count_ = 0;
  }
  void append(const Record& record) { records_[count_++] = record; }
  /// Appends block[b] for every set bit b.
  void append(const Record* block, std::uint32_t lane_bits) {
    for (; lane_bits != 0; lane_bits &= lane_bits - 1) append(block[std::countr_zero(lane_bits)]);
  }

  /// Moves a record to an earlier index, to remove others; shorten() must follow.
  void move(std::size_t from, std::size_t to) { records_[to] = records_[from]; }
  void shorten(std::size_t count) {
    count_ = count;
    finish();
  }

  /// Makes the padding readable. Must be called when the list is complete.
  void finish() { std::memset(static_cast<void*>(records_.data() + count_), 0, padding * sizeof(Record)); }

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] const Record* data() const { return records_.data(); }
  [[nodiscard]] const Record& operator[](std::size_t index) const { return records_[index]; }

 private:
  Buffer<Record> records_;
  std::size_t count_ = 0;
};

/// Candidates of all kinds for one box.
using Candidates = std::array<RecordList, kind_count>;

/// For each child of a box: one bit for each candidate of the box, set if it may be closest somewhere in the child. A
/// word holds the bits of one block of `lanes` candidates.
class ChildBits {
 public:
  void reset(std::size_t blocks) {
    if (words_.size() < 8 * blocks) words_.resize(8 * blocks);
    stride_ = blocks;
  }
  [[nodiscard]] std::uint16_t* child(std::size_t c) { return words_.data() + c * stride_; }
  [[nodiscard]] const std::uint16_t* child(std::size_t c) const { return words_.data() + c * stride_; }
  [[nodiscard]] std::size_t blocks() const { return stride_; }

 private:
  std::vector<std::uint16_t> words_;
  std::size_t stride_ = 0;
};

/// Prepared candidates of a leaf, as a structure of arrays.
class LeafColumns {
 public:
  static constexpr std::size_t padding = 16;

  void reset(std::size_t columns, std::size_t capacity) {
    stride_ = (capacity + padding + 15) / 16 * 16;
    if (values_.size() < columns * stride_) values_ = Buffer<float>(columns * stride_ * 2);
  }
  [[nodiscard]] float* column(std::size_t c) { return values_.data() + c * stride_; }
  [[nodiscard]] const float* column(std::size_t c) const { return values_.data() + c * stride_; }

 private:
  Buffer<float> values_;
  std::size_t stride_ = 0;
};

/// Results of a box of up to 16^3 nodes. Results are buffered so that they can be written to the field as whole cache
/// lines.
struct BoxOutput {
  static constexpr std::int64_t side = 16;
  alignas(64) std::array<float, side * side * side> distance;
  alignas(64) std::array<std::uint32_t, side * side * side> site;
};

struct TileScratch::Impl {
  BoxOutput output;
  /// Data of one level of the recursion: bits that assign candidates to children, and the list of the current child.
  struct Level {
    std::array<ChildBits, kind_count> bits;
    Candidates child;
  };
  std::array<Level, 4> levels;  // boxes with children have 64, 32, 16 or 8 nodes per side; the last entry is for 8
  Candidates gathered;
  std::array<std::vector<std::uint32_t>, kind_count> clusters;  // of the current tile
  std::vector<detail::KeyedIndex> order, order_scratch;
  std::array<LeafColumns, 3> leaf;  // columns of vertices, edges and faces
};

}  // namespace blum::cpu
