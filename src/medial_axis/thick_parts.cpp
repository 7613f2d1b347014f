#include "medial_axis/thick_parts.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/parallel.hpp"

namespace blum {
namespace {

using Words = std::span<const std::uint64_t>;

/// Adds the bits of a row, each moved by up to so many places either way.
void spread_along(Words from, int within, std::span<std::uint64_t> to) {
  for (std::size_t w = 0; w < from.size(); ++w) {
    const std::uint64_t before = w > 0 ? from[w - 1] : 0;
    const std::uint64_t after = w + 1 < from.size() ? from[w + 1] : 0;
    std::uint64_t out = from[w];
    for (int n = 1; n <= within; ++n) {
      out |= from[w] << n | from[w] >> n | before >> (64 - n) | after << (64 - n);
    }
    to[w] |= out;
  }
}

void add(Words from, std::span<std::uint64_t> to) {
  for (std::size_t w = 0; w < from.size(); ++w) to[w] |= from[w];
}

/// Rows end in bits of no voxel, which stay zero.
void clear_beyond(std::int64_t length, std::span<std::uint64_t> row) {
  const auto used = static_cast<std::size_t>(length);
  row[used / 64] &= (std::uint64_t{1} << (used % 64)) - 1;
}

}  // namespace

VoxelSet voxels_near_deep_ones(const VoxelSolid& solid, double depth, int within, const Context& context) {
  const auto& size = solid.grid.size;
  VoxelSet in_layers(size);  // spread along x and y
  const auto for_each_layer = [&](const auto& use) {
    parallel_for(context, static_cast<std::size_t>(size[2]), 1, "thick parts", [&](const WorkRange& range) {
      for (auto k = static_cast<std::int64_t>(range.begin); k < static_cast<std::int64_t>(range.end); ++k) use(k);
    });
  };
  for_each_layer([&](std::int64_t k) {
    std::vector<std::uint64_t> deep(in_layers.words_per_row());
    std::vector<std::uint64_t> wide(in_layers.words_per_row());
    for (std::int64_t j = 0; j < size[1]; ++j) {
      std::fill(deep.begin(), deep.end(), 0);
      std::fill(wide.begin(), wide.end(), 0);
      const float* at = solid.depth.data() + solid.grid.index(0, j, k);
      std::uint64_t any = 0;
      for (std::int64_t i = 0; i < size[0]; ++i) {
        const std::uint64_t is_deep = at[i] > depth ? 1 : 0;
        any |= is_deep;
        deep[static_cast<std::size_t>(i / 64)] |= is_deep << (i % 64);
      }
      if (any == 0) continue;
      spread_along(deep, within, wide);
      clear_beyond(size[0], wide);
      const std::int64_t last = std::min(size[1] - 1, j + within);
      for (std::int64_t to = std::max<std::int64_t>(0, j - within); to <= last; ++to) add(wide, in_layers.row(to, k));
    }
  });
  VoxelSet out(size);
  for_each_layer([&](std::int64_t k) {
    const std::int64_t last = std::min(size[2] - 1, k + within);
    for (std::int64_t from = std::max<std::int64_t>(0, k - within); from <= last; ++from) {
      for (std::int64_t j = 0; j < size[1]; ++j) add(in_layers.row(j, from), out.row(j, k));
    }
  });
  return out;
}

}  // namespace blum
