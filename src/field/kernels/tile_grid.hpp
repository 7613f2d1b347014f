// Blum: tiles of a slab of a grid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "field/kernels/domain_tests.hpp"
#include "field/kernels/normal_frame.hpp"

namespace blum::kernels {

/// Box of nodes: its first node, and the number of nodes along each axis (may be 0).
struct NodeBox {
  std::int32_t first[3];
  std::int32_t count[3];

  [[nodiscard]] BLUM_HD bool is_empty() const { return count[0] <= 0 || count[1] <= 0 || count[2] <= 0; }
};

BLUM_HD inline CenteredBox centered(const NormalFrame& frame, const NodeBox& box) {
  CenteredBox out;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double half_steps = 0.5 * static_cast<double>(box.count[axis] - 1);
    out.center[a] = static_cast<float>(frame.at(axis, static_cast<double>(box.first[axis]) + half_steps));
    out.half[a] = static_cast<float>(frame.spacing[a] * half_steps);
  }
  return out;
}

/// Indices of a node or a tile along the three axes.
struct GridIndex {
  std::int32_t at[3];
};

/// Divides the slices [first_slice, last_slice) of a grid into tiles of `side` nodes per side.
struct TileGrid {
  std::int32_t size[3] = {};  ///< number of nodes of the whole grid along each axis
  std::int32_t first_slice = 0;
  std::int32_t last_slice = 0;
  std::int32_t side = 8;
  std::int32_t tiles[3] = {};

  TileGrid() = default;
  TileGrid(const std::array<std::int64_t, 3>& grid_size, std::int64_t first, std::int64_t last, std::int32_t tile_side)
      : first_slice(static_cast<std::int32_t>(first)), last_slice(static_cast<std::int32_t>(last)), side(tile_side) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      size[axis] = static_cast<std::int32_t>(grid_size[axis]);
      tiles[axis] = ((axis == 2 ? last_slice - first_slice : size[axis]) + side - 1) / side;
    }
  }

  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(tiles[0]) * static_cast<std::size_t>(tiles[1]) * static_cast<std::size_t>(tiles[2]);
  }
  [[nodiscard]] BLUM_HD GridIndex place(std::uint32_t index) const {
    const auto x = static_cast<std::uint32_t>(tiles[0]);
    const auto y = static_cast<std::uint32_t>(tiles[1]);
    return {{static_cast<std::int32_t>(index % x), static_cast<std::int32_t>(index / x % y),
             static_cast<std::int32_t>(index / (x * y))}};
  }
  [[nodiscard]] BLUM_HD std::uint32_t index(const GridIndex& p) const {
    return static_cast<std::uint32_t>((p.at[2] * tiles[1] + p.at[1]) * tiles[0] + p.at[0]);
  }
  [[nodiscard]] BLUM_HD NodeBox box(std::uint32_t tile) const {
    const GridIndex p = place(tile);
    NodeBox out{};
    for (int axis = 0; axis < 3; ++axis) {
      out.first[axis] = p.at[axis] * side + (axis == 2 ? first_slice : 0);
      out.count[axis] = smaller(side, (axis == 2 ? last_slice : size[axis]) - out.first[axis]);
    }
    return out;
  }
};

}  // namespace blum::kernels
