// Blum: how Python calls long work. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <optional>
#include <utility>

#include "blum/core/context.hpp"
#include "blum/core/device.hpp"

namespace blum::python {

/// How a call runs, as Python says it.
struct Call {
  int threads = 0;            ///< as Context::threads
  nanobind::object progress;  ///< None, or called with (fraction, phase) in the thread that called
  Device device = {};         ///< as Context::device
};

/// Runs work in a thread of its own, without the interpreter's lock. Meanwhile the calling thread looks after signals
/// and progress every 50 ms: what a handler (Ctrl-C) or the progress callback raises cancels the work, and is raised
/// here once that has ended. @param work  called once, with `subject`.
void run_call(const Call& call, void (*work)(const void* subject, const Context& context), const void* subject);
template <class Work>
void run_call(const Call& call, const Work& work) {
  const auto begin = [](const void* subject, const Context& context) { (*static_cast<const Work*>(subject))(context); };
  run_call(call, begin, std::addressof(work));
}

/// Registers with Python's atexit what ends the calls of other threads when the interpreter ends: they never return.
void end_calls_at_exit();

/// run_call() for work with a result.
template <class Work>
auto run(const Call& call, const Work& work) {
  using Result = decltype(work(std::declval<const Context&>()));
  std::optional<Result> result;
  run_call(call, [&](const Context& context) { result.emplace(work(context)); });
  return std::move(*result);
}

}  // namespace blum::python
