// Blum: how a call runs (threads, progress, cancellation, device). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <stop_token>
#include <string_view>

#include "blum/core/device.hpp"

namespace blum {

/// Settings for how a call runs. The default uses every core and reports no progress.
struct Context {
  /// Number of threads; 0 means one per core that this process may use. Results never depend on the number of threads.
  int threads = 0;

  /// Function that is called repeatedly during long work, with the name of the current phase and its finished fraction.
  /// In each phase, the fraction rises from 0 to 1. Calls of this function never overlap, but may come from a worker
  /// thread. The function must not throw.
  std::function<void(double fraction, std::string_view phase)> progress = {};

  /// Asks running work to stop. After such a request, the call throws Cancelled within 200 ms.
  std::stop_token cancel = {};

  /// Device that computes fields (distance_field, FieldSolver, distance_transform). All other work runs on the CPU,
  /// even if a CUDA device is set here.
  Device device = {};
};

/// Returns the number of threads of a context: context.threads, or the number of usable cores if context.threads is 0.
/// @throws InvalidOption if context.threads is negative or above 1024.
[[nodiscard]] int thread_count(const Context& context);

/// @throws Cancelled if the caller has asked to stop.
void throw_if_cancelled(const Context& context);

}  // namespace blum
