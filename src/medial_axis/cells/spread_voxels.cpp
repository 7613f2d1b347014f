#include "medial_axis/cells/spread_voxels.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/parallel.hpp"

namespace blum {
namespace {

using Words = std::span<const std::uint64_t>;

/// The bits of a row, each also moved by up to so many places either way.
void spread_along(Words from, int within, std::span<std::uint64_t> to) {
  for (std::size_t w = 0; w < from.size(); ++w) {
    const std::uint64_t before = w > 0 ? from[w - 1] : 0;
    const std::uint64_t after = w + 1 < from.size() ? from[w + 1] : 0;
    to[w] = from[w];
    for (int n = 1; n <= within; ++n) {
      to[w] |= from[w] << n | from[w] >> n | before >> (64 - n) | after << (64 - n);
    }
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

VoxelSet spread(const VoxelSet& from, int within, const Context& context) {
  const auto& size = from.size();
  VoxelSet in_layers(size);  // along x and y
  VoxelSet out(size);
  const auto for_each_layer = [&](const auto& use) {
    parallel_for(context, static_cast<std::size_t>(size[2]), 1, "", [&](const WorkRange& range) {
      for (auto k = static_cast<std::int64_t>(range.begin); k < static_cast<std::int64_t>(range.end); ++k) use(k);
    });
  };
  for_each_layer([&](std::int64_t k) {
    std::vector<std::uint64_t> wide(from.words_per_row());
    for (std::int64_t j = 0; j < size[1]; ++j) {
      const Words row = from.row(j, k);
      if (std::all_of(row.begin(), row.end(), [](std::uint64_t word) { return word == 0; })) continue;
      spread_along(row, within, wide);
      clear_beyond(size[0], wide);
      const std::int64_t last = std::min(size[1] - 1, j + within);
      for (std::int64_t to = std::max<std::int64_t>(0, j - within); to <= last; ++to) add(wide, in_layers.row(to, k));
    }
  });
  for_each_layer([&](std::int64_t k) {
    const std::int64_t last = std::min(size[2] - 1, k + within);
    for (std::int64_t near = std::max<std::int64_t>(0, k - within); near <= last; ++near) {
      for (std::int64_t j = 0; j < size[1]; ++j) add(in_layers.row(j, near), out.row(j, k));
    }
  });
  return out;
}

}  // namespace blum
