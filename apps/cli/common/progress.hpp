// Blum: progress on the terminal, and Ctrl-C. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

#include "blum/core/context.hpp"

namespace blum::cli {

/// A progress bar on stderr, only where stderr is a terminal; it appears after a moment and vanishes at the end.
class Progress {
 public:
  explicit Progress(bool wanted);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(double fraction, std::string_view phase);
  /// Removes the bar from the terminal.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  bool enabled_;
  bool visible_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = {};
};

/// Turns the first Ctrl-C (SIGINT) or SIGTERM into a request to stop, and the second into the end of the process.
/// While nothing listens to the request (reading files, say) even the first one ends the process at once: see
/// Unattended. A signal that was ignored when the process started stays so. At most one may exist.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::thread watcher_;
};

/// Ends the process by the signal that was caught last, so that whoever waits for it sees SIGINT or SIGTERM; returns
/// where there was none. For when all is cleaned up.
void end_by_last_signal();

/// For its lifetime a signal ends the process at once. Only for work that has no output file open.
class Unattended {
 public:
  Unattended();
  ~Unattended();
  Unattended(const Unattended&) = delete;
  Unattended& operator=(const Unattended&) = delete;
};

/// The context of a command: threads, the bar, and cancellation. Both must outlive its use.
[[nodiscard]] Context make_context(int threads, Progress& progress, const Interrupt& interrupt);

}  // namespace blum::cli
