// Blum: what a tile of the second order keeps in memory. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "field/cpu/second_kernel.hpp"
#include "field/cpu/tile_scratch.hpp"

namespace blum::cpu {

/// A box of up to 16^3 nodes, its nodes sorted by their first sites: node (i, j, k) is i + 16 j + 256 k.
/// Whole vectors may be read and written past the end of all arrays.
struct SecondCell {
  static constexpr std::int64_t side = 16;
  static constexpr std::size_t row = 16;
  static constexpr std::size_t layer = 256;
  static constexpr std::size_t nodes = 4096;
  static constexpr std::size_t padding = 64;
  static constexpr std::uint16_t no_group = 0xffff;

  /// Nodes in a row (never of two rows) with the same first site.
  struct Run {
    std::uint16_t node = 0;
    std::uint16_t length = 0;
    std::uint16_t group = no_group;
    std::uint16_t next = 0;  ///< run of the same group
    std::uint16_t at = 0;    ///< where its nodes are in the arrays below
  };
  /// Nodes with the same first site.
  struct Group {
    std::uint32_t site = 0;
    SecondLabels::OfSite labels{};
    std::uint16_t first_run = 0, last_run = 0;
    std::uint16_t begin = 0, end = 0;
  };

  /// First sites by node; dead_record: none, or no node. Begins with room for one before the first.
  static constexpr std::size_t front = 16;
  alignas(64) std::array<std::uint32_t, front + nodes + padding> before_first;
  [[nodiscard]] std::uint32_t* first() { return before_first.data() + front; }
  [[nodiscard]] const std::uint32_t* first() const { return before_first.data() + front; }
  std::array<Run, nodes> runs;
  std::size_t run_count = 0;
  std::array<Group, nodes> groups;
  std::size_t group_count = 0;
  std::array<std::uint16_t, 8192> table;  ///< finds groups: their number and 1
  // By group:
  alignas(64) std::array<float, nodes + padding> x, y, z;  ///< from the cell's middle
  alignas(64) std::array<float, nodes + padding> squared;
  alignas(64) std::array<std::uint32_t, nodes + padding> id;
  // By node:
  alignas(64) std::array<float, nodes + padding> distance;
  alignas(64) std::array<std::uint32_t, nodes + padding> site;
};

struct SecondScratch::Impl {
  TileScratch tile;
  SecondCell cell;
  std::vector<std::uint32_t> links;  ///< of the first site at hand; as long as any have been
  std::vector<float> link_distances;
};

}  // namespace blum::cpu
