// Blum: the surface point nearest to the centre of each tile. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "field/kernels/nearest.hpp"
#include "field/kernels/tile_grid.hpp"

namespace blum::kernels {

/// One warp per tile.
struct FindTilePoints {
  static constexpr std::uint32_t threads = 256;
  static constexpr std::uint32_t blocks_per_processor = 3;  ///< at least, by registers
  static constexpr std::uint32_t warps = threads / warp_size;
  struct Shared {
    SearchStack stack[warps];
  };

  Forest forest;
  const NormalFrame* frame;
  TileGrid tiles;
  const SurfacePoint* coarse;  ///< points of coarser tiles, to begin with; none at the coarsest level
  TileGrid coarse_tiles;
  std::uint32_t count;  ///< of tiles
  SurfacePoint* out;

  template <class Block>
  BLUM_HD void operator()(const Block& block, Shared& shared, std::size_t index) const {
    block.each_warp([&](const typename Block::Warp& warp) {
      const auto tile = static_cast<std::uint32_t>(index) * warps + warp.index();
      if (tile >= count) return;
      const Vec3f center = centered(*frame, tiles.box(tile)).center;
      SurfacePoint best;
      if (coarse != nullptr) {
        GridIndex place = tiles.place(tile);
        for (auto& x : place.at) x = x * tiles.side / coarse_tiles.side;
        best = coarse[coarse_tiles.index(place)];
        best.squared_distance = squared_length(center - best.point);
      }
      if (frame->fault == NormalFrame::Fault::none) {
        NearestSearch<typename Block::Warp>(warp, forest, shared.stack[warp.index()]).run(center, best);
      }
      warp.each([&](std::uint32_t lane) {
        if (lane == 0) out[tile] = best;
      });
    });
  }
};

}  // namespace blum::kernels
