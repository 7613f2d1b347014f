// Proves that spreading adds exactly the voxels near the set, for any number of threads. The reference is a search over
// all voxels.
#include "medial_axis/shape/separation_angles.hpp"

#include <gtest/gtest.h>

#include "blum/core/random.hpp"
#include "support/voxel_sets.hpp"

namespace blum {
namespace {

using detail::spread;

using Place = std::array<std::int64_t, 3>;

VoxelSet sparse(const Place& size, std::uint64_t seed) {
  Random random(seed);
  VoxelSet voxels(size);
  test::for_each_voxel(size, 0, [&](auto i, auto j, auto k) {
    if (random.below(40) == 0) voxels.insert(i, j, k);
  });
  voxels.insert(0, 0, 0);
  voxels.insert(size[0] - 1, size[1] - 1, size[2] - 1);
  return voxels;
}

bool has_near(const VoxelSet& voxels, const Place& at, int within) {
  bool found = false;
  test::for_each_voxel(voxels.size(), 0, [&](auto i, auto j, auto k) {
    const bool is_near =
        std::abs(i - at[0]) <= within && std::abs(j - at[1]) <= within && std::abs(k - at[2]) <= within;
    found = found || (is_near && voxels.contains(i, j, k));
  });
  return found;
}

TEST(SpreadVoxels, HaveAVoxelOfTheSetNearby) {
  for (const Place& size : {Place{7, 6, 5}, Place{64, 3, 3}, Place{63, 2, 4}, Place{65, 3, 2}, Place{130, 2, 2}}) {
    const VoxelSet voxels = sparse(size, static_cast<std::uint64_t>(size[0]));
    for (const int within : {0, 1, 2, 3}) {
      SCOPED_TRACE(testing::Message() << size[0] << " " << size[1] << " " << size[2] << ", within " << within);
      VoxelSet expected(size);
      test::for_each_voxel(size, 0, [&](auto i, auto j, auto k) {
        if (has_near(voxels, {i, j, k}, within)) expected.insert(i, j, k);
      });
      for (const int threads : {1, 2, 7}) EXPECT_EQ(spread(voxels, within, {.threads = threads}), expected);
    }
  }
}

}  // namespace
}  // namespace blum
