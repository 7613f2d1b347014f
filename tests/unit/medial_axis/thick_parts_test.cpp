// Proves that the thick parts of a solid are the voxels with a deep one near, as plain counting finds them.
#include "medial_axis/thick_parts.hpp"

#include <gtest/gtest.h>

#include "blum/core/random.hpp"
#include "support/voxel_sets.hpp"

namespace blum {
namespace {

using Place = std::array<std::int64_t, 3>;

/// Depths of which few are above 1.
VoxelSolid sample(const Place& size, std::uint64_t seed) {
  Random random(seed);
  VoxelSolid solid;
  solid.grid.size = size;
  solid.depth = Buffer<float>(solid.grid.node_count());
  for (std::size_t v = 0; v < solid.grid.node_count(); ++v) {
    solid.depth.data()[v] = static_cast<float>(random.below(40)) / 38.5F;
  }
  return solid;
}

bool has_deep_one(const VoxelSolid& solid, const Place& at, int within) {
  bool found = false;
  test::for_each_voxel(solid.grid.size, 0, [&](auto i, auto j, auto k) {
    const bool is_near =
        std::abs(i - at[0]) <= within && std::abs(j - at[1]) <= within && std::abs(k - at[2]) <= within;
    found = found || (is_near && solid.depth.data()[solid.grid.index(i, j, k)] > 1);
  });
  return found;
}

TEST(ThickParts, AreTheVoxelsWithADeepOneNear) {
  for (const Place& size : {Place{7, 6, 5}, Place{64, 3, 3}, Place{63, 2, 4}, Place{65, 3, 2}, Place{130, 2, 2}}) {
    const VoxelSolid solid = sample(size, static_cast<std::uint64_t>(size[0]));
    for (const int within : {0, 1, 2, 3}) {
      SCOPED_TRACE(testing::Message() << size[0] << " " << size[1] << " " << size[2] << ", within " << within);
      const VoxelSet near = voxels_near_deep_ones(solid, 1, within, {});
      VoxelSet expected(size);
      test::for_each_voxel(size, 0, [&](auto i, auto j, auto k) {
        if (has_deep_one(solid, {i, j, k}, within)) expected.insert(i, j, k);
      });
      EXPECT_EQ(near, expected);
      EXPECT_GT(expected.count(), 0);
      for (const int threads : {1, 7}) EXPECT_EQ(voxels_near_deep_ones(solid, 1, within, {.threads = threads}), near);
    }
  }
}

}  // namespace
}  // namespace blum
