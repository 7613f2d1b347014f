// Blum: memory of a tile of the second order. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include "field/cpu/second_kernel.hpp"
#include "field/cpu/tile_scratch.hpp"

namespace blum::cpu {

/// Box of up to 16^3 nodes, stored leaf after leaf. The index of node (i, j, k) of leaf (a, b, c) is i + 4 j + 16 k +
/// 64 (a + 4 b + 16 c). The nodes of a cell are also grouped by first site.
struct SecondCell {
  static constexpr std::int64_t side = 16;
  static constexpr std::size_t row = 16;
  static constexpr std::size_t leaves = 64;
  static constexpr std::uint32_t nodes = 4096;
  static constexpr std::size_t padding = 32;

  /// Nodes of one leaf with the same first site.
  struct Item {
    std::uint64_t nodes = 0;  ///< one bit for each node of the leaf
    std::uint16_t leaf = 0;
    std::uint16_t next = 0;  ///< next item of the same group
  };
  /// All nodes of the cell with the same first site.
  struct Group {
    std::uint32_t site = 0;
    SecondLabels::OfSite labels{};
    std::uint16_t first_item = 0, last_item = 0;
    std::uint16_t begin = 0, end = 0;  ///< range in `order`
  };

  /// First sites. dead_record: the node has none, or does not exist.
  alignas(64) std::array<std::uint32_t, nodes> first;
  /// Squared distances and ids of the second sites found so far. The distance is below 0 if the node has no first site.
  alignas(64) std::array<float, nodes + padding> squared;
  alignas(64) std::array<std::uint32_t, nodes + padding> id;
  std::array<Item, nodes> items;
  std::size_t item_count = 0;
  std::array<Group, nodes> groups;
  std::size_t group_count = 0;
  std::array<std::uint16_t, 8192> table;  ///< Hash table of groups. An entry is the group's index + 1.
  /// Nodes that have a first site, group after group. Indices of a node that does not exist follow, so that whole
  /// vectors can be read.
  alignas(64) std::array<std::uint32_t, nodes + padding> order{};
};

/// Candidates of one kind, as indices into the list of the tile's records. Boxes within the tile use the same list,
/// because copying records would cost more than all tests of them.
class PlaceList {
 public:
  static constexpr std::size_t padding = 16;

  /// Empties the list and makes room for `capacity` indices.
  void reset(const RecordList& records, std::size_t capacity) {
    records_ = &records;
    if (places_.size() < capacity + 2 * padding) places_ = Buffer<std::uint32_t>(capacity + capacity / 2 + 4 * padding);
    count_ = 0;
  }
  void reset_to_all(const RecordList& records) {
    reset(records, records.count());
    std::iota(places_.begin(), places_.begin() + records.count(), 0U);
    finish(records.count());
  }
  /// Returns the memory for the indices. The caller writes indices before finish() sets their number; up to `padding`
  /// indices may be written at a time.
  [[nodiscard]] std::uint32_t* places() { return places_.data(); }
  [[nodiscard]] const std::uint32_t* places() const { return places_.data(); }
  /// Sets the number of indices, and makes the padding readable.
  void finish(std::size_t count) {
    count_ = count;
    std::fill_n(places_.data() + count, padding, 0U);
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] const RecordList& records() const { return *records_; }
  [[nodiscard]] const Record& operator[](std::size_t index) const { return (*records_)[places_[index]]; }

 private:
  const RecordList* records_ = nullptr;
  Buffer<std::uint32_t> places_;
  std::size_t count_ = 0;
};

/// Candidates of all kinds for one box.
struct SecondCandidates {
  std::array<PlaceList, sliver_kind> places;
  RecordList slivers;

  [[nodiscard]] const PlaceList& operator[](std::size_t kind) const { return places[kind]; }
};

struct SecondScratch::Impl {
  TileScratch tile;
  SecondCandidates all;                    ///< of the current tile
  std::array<SecondCandidates, 4> levels;  ///< of the current child, for each level of the recursion in the tile
  SecondCell cell;
  std::vector<std::uint32_t> links;  ///< of the current first site; never shrinks
  std::vector<float> link_distances;
};

}  // namespace blum::cpu
