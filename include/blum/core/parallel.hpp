// Blum: parallel loops; the only header through which Blum starts threads. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

#include "blum/core/context.hpp"

namespace blum {

/// Half-open range of items, and the worker that runs it. Workers are numbered from 0 to thread_count() - 1, so that
/// each can have its own scratch space.
struct WorkRange {
  std::size_t begin = 0;
  std::size_t end = 0;
  int worker = 0;
};

/// Time at which the other workers join the calling thread in a parallel loop.
enum class Start {
  /// The calling thread begins alone. Others join after 50 us, if the loop is expected to take 150 us more. So a short
  /// loop costs the same with any number of threads. A loop of few long ranges loses the time of its first range.
  measured,
  /// Other workers join at the beginning. Use this value for loops of few long ranges.
  at_once,
};

/// Calls `body` for consecutive ranges of at most `grain` items, which together cover [0, count). Workers start the
/// ranges in ascending order.
///
/// The ranges depend only on `count` and `grain`, never on the number of threads. So results are the same for any
/// number of threads if `body` writes only data of its own range. A single worker runs on the calling thread. The loop
/// does not wait for threads that are busy elsewhere.
///
/// @param phase  name for Context::progress. An empty name reports no progress.
/// @param body   must not throw, except std::bad_alloc. The first exception is rethrown once all workers have stopped.
/// @throws Cancelled if the caller asked to stop. This is checked before every range.
void parallel_for(const Context& context, std::size_t count, std::size_t grain, std::string_view phase,
                  const std::function<void(const WorkRange&)>& body, Start start = Start::measured);

/// Returns the thread back end that was compiled in: "tbb", "std" or "serial".
[[nodiscard]] std::string_view thread_backend();

}  // namespace blum
