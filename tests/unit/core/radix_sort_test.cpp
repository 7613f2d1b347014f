// Proves that small keys are sorted like in a stable sort, on both sides of the count at which the digits change.
#include "blum/core/radix_sort.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "blum/core/random.hpp"

namespace blum::detail {
namespace {

TEST(RadixSort, AgreesWithAStableSort) {
  Random random(1);
  std::vector<KeyedIndex> scratch;
  for (const std::uint32_t count : {0U, 1U, 2U, 255U, 2047U, 2048U, 5000U}) {
    for (int kind = 0; kind < 5; ++kind) {
      std::vector<KeyedIndex> items(count);
      for (std::uint32_t i = 0; i < count; ++i) {
        const auto any = static_cast<std::uint32_t>(random.below(std::uint64_t{1} << 32));
        // Keys have all bits, few values, one value, the bits of distances, or only the largest and smallest value.
        const std::array<std::uint32_t, 5> keys{any, any % 7, 5,
                                                std::bit_cast<std::uint32_t>(static_cast<float>(any) * 1e-9F),
                                                any % 2 == 0 ? 0U : 0xffffffffU};
        items[i] = {keys[static_cast<std::size_t>(kind)], i};
      }
      std::vector<KeyedIndex> expected = items;
      // Indices rise in the given order, so a stable sort by keys gives the same.
      std::sort(expected.begin(), expected.end(), [](const KeyedIndex& a, const KeyedIndex& b) {
        return std::pair(a.key, a.index) < std::pair(b.key, b.index);
      });
      radix_sort(items, scratch);
      const auto same = [](const KeyedIndex& a, const KeyedIndex& b) { return a.key == b.key && a.index == b.index; };
      EXPECT_TRUE(std::equal(items.begin(), items.end(), expected.begin(), expected.end(), same))
          << count << " items, kind " << kind;
    }
  }
}

}  // namespace
}  // namespace blum::detail
