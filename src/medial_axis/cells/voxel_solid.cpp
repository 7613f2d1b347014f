#include "medial_axis/cells/voxel_solid.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

#include "blum/core/parallel.hpp"

namespace blum::detail {

void take_deeper_than(std::span<const float> depth, double limit, VoxelSet& voxels, const Context& context) {
  const std::array<std::int64_t, 3> size = voxels.size();
  voxels = VoxelSet(size);
  parallel_for(context, static_cast<std::size_t>(size[2]), 1, "", [&](const WorkRange& range) {
    for (auto k = static_cast<std::int64_t>(range.begin); k < static_cast<std::int64_t>(range.end); ++k) {
      if (k == 0 || k + 1 == size[2]) continue;
      for (std::int64_t j = 1; j + 1 < size[1]; ++j) {
        for (std::int64_t i = 1; i + 1 < size[0]; ++i) {
          const auto voxel = static_cast<std::size_t>((k * size[1] + j) * size[0] + i);
          if (static_cast<double>(depth[voxel]) > limit) voxels.insert(i, j, k);
        }
      }
    }
  });
}

}  // namespace blum::detail
