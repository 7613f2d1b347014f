// Blum: stable sorting of small keys. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace blum::cpu {

struct KeyedIndex {
  std::uint32_t key = 0;
  std::uint32_t index = 0;
};

/// Sorts by key, equal keys in their given order. Cost: three passes of 11 bits; passes in which all keys agree are
/// skipped. `scratch` keeps its memory between calls.
inline void radix_sort(std::vector<KeyedIndex>& items, std::vector<KeyedIndex>& scratch) {
  constexpr unsigned bits = 11;
  constexpr std::size_t buckets = std::size_t{1} << bits;
  std::array<std::array<std::uint32_t, buckets>, 3> counts{};
  for (const KeyedIndex& item : items) {
    for (unsigned pass = 0; pass < 3; ++pass) ++counts[pass][(item.key >> (pass * bits)) & (buckets - 1)];
  }
  scratch.resize(items.size());
  for (unsigned pass = 0; pass < 3; ++pass) {
    std::uint32_t start = 0;
    bool all_agree = false;
    for (std::uint32_t& count : counts[pass]) {
      all_agree = all_agree || count == items.size();
      start += std::exchange(count, start);
    }
    if (all_agree) continue;
    for (const KeyedIndex& item : items) scratch[counts[pass][(item.key >> (pass * bits)) & (buckets - 1)]++] = item;
    items.swap(scratch);
  }
}

inline void radix_sort(std::vector<KeyedIndex>& items) {
  std::vector<KeyedIndex> scratch;
  radix_sort(items, scratch);
}

}  // namespace blum::cpu
