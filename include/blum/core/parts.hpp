// Blum: work on parts of a whole, with small parts in parallel. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/core/parallel.hpp"

namespace blum::detail {

/// Calls run(part, context) once for each part, the largest part first. A part is large if its size exceeds the sum of
/// all sizes, divided by the number of threads. Large parts run one after another, with the given context. The small
/// parts run in parallel, each with a context that has one thread and reports no progress. If there is only one small
/// part, it also runs with the given context.
/// @param sizes  size of each part, proportional to its running time.
/// @param phase  as for parallel_for(), for the parts that run in parallel.
/// @throws Cancelled, and any exception of run().
template <class Run>
void for_each_part(const Context& context, std::span<const std::size_t> sizes, std::string_view phase, const Run& run) {
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return std::pair(sizes[b], a) < std::pair(sizes[a], b); });
  const std::size_t all = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
  const auto threads = static_cast<std::size_t>(thread_count(context));
  std::size_t large = 0;
  while (large < order.size() && (sizes[order[large]] > all / threads || large + 1 == order.size())) {
    run(order[large++], context);
  }
  const Context alone{.threads = 1, .cancel = context.cancel, .device = context.device};
  parallel_for(
      context, order.size() - large, 1, phase, [&](const WorkRange& range) { run(order[large + range.begin], alone); },
      Start::at_once);
}

}  // namespace blum::detail
