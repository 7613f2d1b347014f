#include "blum/grid/voxel_set.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace blum {

VoxelExtent extent_of(const VoxelSet& voxels) {
  constexpr auto far = std::numeric_limits<std::int64_t>::max();
  VoxelExtent out{{far, far, far}, {0, 0, 0}};
  const std::array<std::int64_t, 3>& size = voxels.size();
  const auto include = [&](const std::array<std::int64_t, 3>& at) {
    for (std::size_t a = 0; a < 3; ++a) {
      out.lower[a] = std::min(out.lower[a], at[a]);
      out.upper[a] = std::max(out.upper[a], at[a] + 1);
    }
  };
  for (std::int64_t k = 0; k < size[2]; ++k) {
    for (std::int64_t j = 0; j < size[1]; ++j) {
      const auto row = voxels.row(j, k);
      std::int64_t first = -1;
      std::int64_t last = -1;
      for (std::size_t w = 0; w < row.size(); ++w) {
        if (row[w] == 0) continue;
        const auto base = static_cast<std::int64_t>(64 * w);
        if (first < 0) first = base + std::countr_zero(row[w]);
        last = base + 63 - std::countl_zero(row[w]);
      }
      if (first < 0) continue;
      include({first, j, k});
      include({last, j, k});
    }
  }
  return out;
}

}  // namespace blum
