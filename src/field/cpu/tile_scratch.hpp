// Blum: lists of candidates that shrink from tile to leaf. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstring>

#include "field/cpu/radix_sort.hpp"
#include "field/cpu/tile_kernel.hpp"

namespace blum::cpu {

/// Records of one kind that may matter in a box, in rising order of site id (so that ties go to the smaller id).
/// Readable up to a whole number of vectors past the end: the padding holds records that are nowhere.
class RecordList {
 public:
  static constexpr std::size_t padding = 16;

  /// Empties the list and makes room for `capacity` records.
  void reset(std::size_t capacity) {
    if (records_.size() < capacity + padding) records_ = Buffer<Record>(capacity + capacity / 2 + padding);
    count_ = 0;
  }
  void append(const Record& record) { records_[count_++] = record; }
  /// Makes the padding readable; to be called once the list is complete.
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

/// Prepared candidates of a leaf: structure of arrays, read lane by lane.
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

struct TileScratch::Impl {
  static constexpr std::size_t levels = 4;  // boxes of 64, 32, 16 and 8 nodes have children
  std::array<std::array<Candidates, 8>, levels> children;
  Candidates gathered;
  std::array<std::vector<std::uint32_t>, kind_count> clusters;  // of the tile at hand
  std::vector<KeyedIndex> order, order_scratch;
  std::array<LeafColumns, 3> leaf;  // vertices, edges, faces
};

}  // namespace blum::cpu
