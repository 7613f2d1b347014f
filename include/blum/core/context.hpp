// Blum: how a call runs (threads, progress, cancellation, device). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <stop_token>
#include <string_view>

#include "blum/core/device.hpp"

namespace blum {

/// How a call runs, as a value that is passed along. The default uses every core, silently.
struct Context {
  /// Number of threads; 0 means one per core that this process may use. Results never depend on it.
  int threads = 0;

  /// Called now and then during long work with the finished fraction of the current phase (0 to 1, rising) and the
  /// phase's name. Calls never overlap, but may come from a worker thread. Must not throw.
  std::function<void(double fraction, std::string_view phase)> progress = {};

  /// Asks running work to stop; the call then throws Cancelled, within 200 ms.
  std::stop_token cancel = {};

  /// Where fields are computed (distance_field, FieldSolver, distance_transform); everything else computes on the CPU
  /// whatever this says.
  Device device = {};
};

/// The number of threads that a context stands for: context.threads, or the number of usable cores when that is 0.
/// @throws InvalidOption when context.threads is negative or above 1024.
[[nodiscard]] int thread_count(const Context& context);

/// @throws Cancelled when the caller has asked to stop.
void throw_if_cancelled(const Context& context);

}  // namespace blum
