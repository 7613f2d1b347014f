// Proves that bit_count() agrees with std::popcount(), and that short lists in place behave like std::vector. Large
// lists have default values.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/core/bits.hpp"
#include "blum/core/huge_pages.hpp"
#include "blum/core/inline_list.hpp"
#include "blum/core/random.hpp"

namespace blum {
namespace {

TEST(BitCount, AgreesWithTheStandardLibrary) {
  Random random(1);
  for (const std::uint64_t bits : {std::uint64_t{0}, std::uint64_t{1}, ~std::uint64_t{0}, std::uint64_t{1} << 63U}) {
    EXPECT_EQ(bit_count(bits), static_cast<std::uint32_t>(std::popcount(bits)));
  }
  for (int k = 0; k < 1000; ++k) {
    std::uint64_t bits = random.bits();
    if (k % 2 == 0) bits &= random.bits() & random.bits();
    EXPECT_EQ(bit_count(bits), static_cast<std::uint32_t>(std::popcount(bits)));
  }
}

struct Item {
  double value = 7;
  std::uint32_t number = 0;
  friend bool operator==(const Item&, const Item&) = default;
};

TEST(InlineList, BehavesLikeAVector) {
  Random random(2);
  InlineList<Item, 16> list;
  std::vector<Item> expected;
  for (std::uint32_t step = 0; step < 2000; ++step) {
    const std::uint64_t what = random.below(5);
    if (what < 3 && !list.is_full()) {
      list.push_back({random.uniform(), step});
      expected.push_back(list[list.size() - 1]);
    } else if (what == 3 && !list.empty()) {
      EXPECT_EQ(list.pop_back(), expected.back());
      expected.pop_back();
    } else if (what == 4) {
      const std::size_t size = list.size() / 2;
      list.shrink(size);
      expected.resize(size);
    }
    ASSERT_EQ(list.size(), expected.size());
    ASSERT_EQ(list.is_full(), expected.size() == 16);
    ASSERT_TRUE(std::equal(list.begin(), list.end(), expected.begin(), expected.end()));
    const InlineList<Item, 16> copy = list;
    ASSERT_TRUE(std::equal(copy.begin(), copy.end(), expected.begin(), expected.end()));
    ASSERT_EQ(copy.span().size(), expected.size());
    InlineList<Item, 16> other;
    other = copy;
    ASSERT_TRUE(std::equal(other.begin(), other.end(), expected.begin(), expected.end()));
  }
}

// On both sides of the size from which lists use huge pages.
TEST(LargeList, HoldsDefaultValues) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{5}, std::size_t{300000}}) {
    const std::vector<Item> list = detail::large_list<Item>(size);
    ASSERT_EQ(list.size(), size);
    EXPECT_TRUE(std::all_of(list.begin(), list.end(), [](const Item& item) { return item == Item{}; }));
  }
}

}  // namespace
}  // namespace blum
