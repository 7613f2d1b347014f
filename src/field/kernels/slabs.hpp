// Blum: cuts a grid into slabs of slices. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "blum/grid/grid_spec.hpp"
#include "field/kernels/compute_tiles.hpp"

namespace blum::kernels {

/// Slabs of whole tiles of both sizes, so that they do not change which tile a node is in.
class Slabs {
 public:
  /// @param nodes  of a slab at most, but for grids whose slices are too large.
  Slabs(const GridSpec& grid, std::size_t nodes)
      : per_slice_(static_cast<std::size_t>(grid.size[0]) * static_cast<std::size_t>(grid.size[1])),
        size_(grid.size[2]) {
    constexpr std::int64_t unit = 4 * ComputeTiles::side;
    const auto fitting = static_cast<std::int64_t>(nodes / std::max<std::size_t>(per_slice_, 1));
    slices_ = std::max(unit, fitting / unit * unit);
  }

  [[nodiscard]] std::int64_t count() const { return (size_ + slices_ - 1) / slices_; }
  [[nodiscard]] std::int64_t first_slice(std::int64_t slab) const { return slab * slices_; }
  [[nodiscard]] std::int64_t last_slice(std::int64_t slab) const { return std::min((slab + 1) * slices_, size_); }
  [[nodiscard]] std::size_t first_node(std::int64_t slab) const {
    return static_cast<std::size_t>(first_slice(slab)) * per_slice_;
  }
  [[nodiscard]] std::size_t nodes(std::int64_t slab) const {
    return static_cast<std::size_t>(last_slice(slab) - first_slice(slab)) * per_slice_;
  }

 private:
  std::size_t per_slice_;
  std::int64_t size_;
  std::int64_t slices_ = 0;
};

}  // namespace blum::kernels
