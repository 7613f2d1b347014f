// Blum: parts of a whole, the small ones side by side. SPDX-License-Identifier: Apache-2.0
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

/// Calls run(part, context) once for each part: for one that is more than a thread's share of all with the context
/// given, for the others side by side, the largest first, each with a context of one thread, that tells no progress.
/// @param sizes  of the parts: how long each takes, in any unit.
/// @param phase  as parallel_for() takes it, for the parts that run side by side.
/// @throws Cancelled, and what run() throws.
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
  parallel_for(context, order.size() - large, 1, phase,
               [&](const WorkRange& range) { run(order[large + range.begin], alone); });
}

}  // namespace blum::detail
