// Blum: the work of traces, and a limit on it. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

namespace blum::voronoi {

/// Counts examined sites, and points that Newton's method finds. The count depends on the solid alone, so a limit stops
/// all runs at the same place. Belongs to one thread.
struct TraceWork {
  std::uint64_t done = 0;
  std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  [[nodiscard]] bool is_exhausted() const { return done > most; }
  [[nodiscard]] std::uint64_t left() const { return is_exhausted() ? 0 : most - done; }
};

}  // namespace blum::voronoi
