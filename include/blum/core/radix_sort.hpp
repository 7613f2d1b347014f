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

/// Sorts by key, `bits` bits at a time. Equal keys keep their order.
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
    // If all keys have the same digit, the bucket of the first key's digit counts all of them.
    const std::uint32_t digit = items.empty() ? 0 : (items.front().key >> (pass * bits)) & (buckets - 1);
    if (counts[pass][digit] == items.size()) continue;
    std::uint32_t start = 0;
    for (std::uint32_t& count : counts[pass]) start += std::exchange(count, start);
    for (const KeyedIndex& item : items) scratch[counts[pass][(item.key >> (pass * bits)) & (buckets - 1)]++] = item;
    items.swap(scratch);
  }
}

/// Sorts items by key; items with equal keys keep their order. Cost: at most four passes over the items. A pass is
/// skipped if all keys have the same digit in it. `scratch` keeps its memory between calls.
inline void radix_sort(std::vector<KeyedIndex>& items, std::vector<KeyedIndex>& scratch) {
  // Short lists use fewer counts, because clearing and summing many counts would cost more than it saves.
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
