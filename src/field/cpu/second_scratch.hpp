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

/// Box of up to 16^3 nodes, leaf after leaf: node (i, j, k) of leaf (a, b, c) is i + 4 j + 16 k + 64 (a + 4 b + 16 c).
/// Its nodes are also sorted by first sites.
struct SecondCell {
  static constexpr std::int64_t side = 16;
  static constexpr std::size_t row = 16;
  static constexpr std::size_t leaves = 64;
  static constexpr std::uint32_t nodes = 4096;
  static constexpr std::size_t padding = 32;

  /// Nodes of a leaf with the same first site.
  struct Item {
    std::uint64_t nodes = 0;  ///< a bit for each node
    std::uint16_t leaf = 0;
    std::uint16_t next = 0;  ///< next item of the same group
  };
  /// Nodes with the same first site.
  struct Group {
    std::uint32_t site = 0;
    SecondLabels::OfSite labels{};
    std::uint16_t first_item = 0, last_item = 0;
    std::uint16_t begin = 0, end = 0;  ///< range in `order`
  };

  alignas(64) std::array<std::uint32_t, nodes> first;  ///< First sites; dead_record: none, or not a node.
  /// Squared distances and ids of the second sites so far; the former are below 0 without a first site.
  alignas(64) std::array<float, nodes + padding> squared;
  alignas(64) std::array<std::uint32_t, nodes + padding> id;
  std::array<Item, nodes> items;
  std::size_t item_count = 0;
  std::array<Group, nodes> groups;
  std::size_t group_count = 0;
  std::array<std::uint16_t, 8192> table;  ///< Hash table of groups: number of the group + 1.
  /// Nodes that have a first site, group after group. Past the end comes a node that does not exist, for whole vectors.
  alignas(64) std::array<std::uint32_t, nodes + padding> order{};
};

/// Candidates of one kind, as places in the list of a tile's records. Children share that list, because copies of
/// records would cost more than all tests of them.
class PlaceList {
 public:
  static constexpr std::size_t padding = 16;

  /// Empties the list and makes room for `capacity` places.
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
  /// Returns the memory to which up to `padding` places at a time are written, before finish() sets their number.
  [[nodiscard]] std::uint32_t* places() { return places_.data(); }
  [[nodiscard]] const std::uint32_t* places() const { return places_.data(); }
  /// Sets the number of places, and makes the padding readable.
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
  std::array<SecondCandidates, 4> levels;  ///< of the current child, for each level of the tile's
  SecondCell cell;
  std::vector<std::uint32_t> links;  ///< of the current first site; never shrinks
  std::vector<float> link_distances;
};

}  // namespace blum::cpu
