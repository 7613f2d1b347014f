// Blum: stable sorting of small keys. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace blum::detail {

struct KeyedIndex {
  std::uint32_t key = 0;
  std::uint32_t index = 0;
};

/// Sorts by key with digits of some bits, equal keys in their given order.
template <unsigned bits>
void sort_by_digits(std::vector<KeyedIndex>& items, std::vector<KeyedIndex>& scratch) {
  constexpr std::size_t buckets = std::size_t{1} << bits;
  constexpr unsigned passes = (32 + bits - 1) / bits;
  std::array<std::array<std::uint32_t, buckets>, passes> counts{};
  for (const KeyedIndex& item : items) {
    for (unsigned pass = 0; pass < passes; ++pass) ++counts[pass][(item.key >> (pass * bits)) & (buckets - 1)];
  }
  scratch.resize(items.size());
  for (unsigned pass = 0; pass < passes; ++pass) {
    // All keys agree where one does with all.
    const std::uint32_t digit = items.empty() ? 0 : (items.front().key >> (pass * bits)) & (buckets - 1);
    if (counts[pass][digit] == items.size()) continue;
    std::uint32_t start = 0;
    for (std::uint32_t& count : counts[pass]) start += std::exchange(count, start);
    for (const KeyedIndex& item : items) scratch[counts[pass][(item.key >> (pass * bits)) & (buckets - 1)]++] = item;
    items.swap(scratch);
  }
}

/// Sorts by key, equal keys in their given order. Cost: at most four passes; those in which all keys agree are skipped.
/// `scratch` keeps its memory between calls.
inline void radix_sort(std::vector<KeyedIndex>& items, std::vector<KeyedIndex>& scratch) {
  // Few items are not worth the clearing and summing up of many counts.
  if (items.size() < 2048) {
    sort_by_digits<8>(items, scratch);
  } else {
    sort_by_digits<11>(items, scratch);
  }
}

inline void radix_sort(std::vector<KeyedIndex>& items) {
  std::vector<KeyedIndex> scratch;
  radix_sort(items, scratch);
}

}  // namespace blum::detail
