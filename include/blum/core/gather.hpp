// Blum: lists that many threads fill. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "blum/core/parallel.hpp"

namespace blum::detail {

/// Calls find(k, out) for each k below `count`, and returns all values that these calls append to `out`. The values are
/// in the order of k, for any number of threads.
/// @param phase  as for parallel_for().  @throws Cancelled.
template <class T, class Find>
[[nodiscard]] std::vector<T> gather(const Context& context, std::size_t count, std::size_t grain,
                                    std::string_view phase, const Find& find) {
  std::vector<std::vector<T>> parts((count + grain - 1) / grain);
  parallel_for(context, count, grain, phase, [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) find(k, parts[range.begin / grain]);
  });
  std::vector<T> all;
  for (const std::vector<T>& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace blum::detail
