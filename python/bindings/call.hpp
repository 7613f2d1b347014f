// Blum: calls of long computations from Python. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <optional>
#include <utility>

#include "blum/core/context.hpp"
#include "blum/core/device.hpp"

namespace blum::python {

/// Settings of a call, given by Python.
struct Call {
  int threads = 0;            ///< As Context::threads.
  nanobind::object progress;  ///< None, or called with (fraction, phase) in the calling thread.
  Device device = {};         ///< As Context::device.
};

/// Runs work in its own thread, without the interpreter's lock. Every 50 ms the calling thread handles signals and
/// progress. An exception of a signal handler (Ctrl-C) or of the progress callback cancels the work. It is raised here
/// after the work has ended.
/// @param work  called once, with `subject`.
void run_call(const Call& call, void (*work)(const void* subject, const Context& context), const void* subject);
template <class Work>
void run_call(const Call& call, const Work& work) {
  const auto begin = [](const void* subject, const Context& context) { (*static_cast<const Work*>(subject))(context); };
  run_call(call, begin, std::addressof(work));
}

/// Runs work in the calling thread, without the interpreter's lock, for at most a few dozen milliseconds. Signals and
/// progress are not handled meanwhile.
/// @return  false if the work was stopped because it took longer.
[[nodiscard]] bool run_brief_call(const Call& call, void (*work)(const void* subject, const Context& context),
                                  const void* subject);

/// Registers a function with Python's atexit that stops the calls of other threads when the interpreter ends. These
/// calls never return.
void end_calls_at_exit();

/// Runs work as run_call() does, and returns its result.
template <class Work>
auto run(const Call& call, const Work& work) {
  using Result = decltype(work(std::declval<const Context&>()));
  std::optional<Result> result;
  run_call(call, [&](const Context& context) { result.emplace(work(context)); });
  return std::move(*result);
}

/// Runs work as run() does. Starting a thread takes longer than most queries of scenes, so the work first runs in the
/// calling thread. Work that takes longer starts again in its own thread.
/// @param work  must have no effect but its result; it may be called twice.
template <class Work>
auto run_brief(const Call& call, const Work& work) {
  using Result = decltype(work(std::declval<const Context&>()));
  if (!call.progress.is_none()) return run(call, work);
  std::optional<Result> result;
  const auto keep = [&](const Context& context) { result.emplace(work(context)); };
  const auto begin = [](const void* subject, const Context& context) {
    (*static_cast<const decltype(keep)*>(subject))(context);
  };
  if (run_brief_call(call, begin, std::addressof(keep))) return std::move(*result);
  return run(call, work);
}

}  // namespace blum::python
