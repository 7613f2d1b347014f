// Blum: parallel loops; the only header through which Blum starts threads. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

#include "blum/core/context.hpp"

namespace blum {

/// A half-open range of items, and which of the thread_count() workers runs it (for per-worker scratch space).
struct WorkRange {
  std::size_t begin = 0;
  std::size_t end = 0;
  int worker = 0;
};

/// Runs body over [0, count), cut into consecutive ranges of at most `grain` items that workers take in rising order.
///
/// The cut depends on count and grain only, never on the number of threads, so a body that writes only what belongs
/// to its range gives the same result on any number of threads. A single worker runs on the calling thread.
///
/// @param phase  name for Context::progress; an empty name reports no progress.
/// @param body   must not throw, except std::bad_alloc: the first exception is rethrown once all workers have stopped.
/// @throws Cancelled when the caller asked to stop (looked at before every range).
void parallel_for(const Context& context, std::size_t count, std::size_t grain, std::string_view phase,
                  const std::function<void(const WorkRange&)>& body);

/// The thread back end that was compiled in: "tbb", "std" or "serial".
[[nodiscard]] std::string_view thread_backend();

}  // namespace blum
