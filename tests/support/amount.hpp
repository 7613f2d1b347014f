// Blum: how many cases of large families are tested, as tests/python/amount.py. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace blum::test {

/// Returns true if the environment variable BLUM_TESTS is "all". Tests then take all cases.
inline bool are_all_tested() {
  const char* amount = std::getenv("BLUM_TESTS");
  return amount != nullptr && std::string_view(amount) == "all";
}

/// Returns all items if all cases are tested, else `count` of them, evenly spread.
/// @param shift  of the chosen items, so that repeated calls choose other ones.
template <class T>
std::vector<T> some(const std::vector<T>& items, std::size_t count, std::size_t shift = 0) {
  if (are_all_tested() || count >= items.size()) return items;
  std::vector<T> out;
  for (std::size_t k = 0; k < count; ++k) out.push_back(items[(k * items.size() / count + shift) % items.size()]);
  return out;
}

}  // namespace blum::test
