// Blum: progress on the terminal, and Ctrl-C. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

#include "blum/core/context.hpp"

namespace blum::cli {

/// Progress bar on stderr. It is shown only if stderr is a terminal. It appears after 0.4 s and is removed at the end.
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

/// Handles SIGINT (Ctrl-C) and SIGTERM. The first signal requests a stop, and the second one ends the process. Some
/// code does not poll the request, for example while files are read. There, Unattended makes the first signal end the
/// process. A signal that was ignored when the process started stays ignored. At most one object may exist.
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

/// If a signal was caught, ends the process by the last one, so that its parent process sees SIGINT or SIGTERM.
/// Otherwise returns. Call it after all clean-up.
void end_by_last_signal();

/// During its lifetime, a signal ends the process at once. Use it only while no output file is open.
class Unattended {
 public:
  Unattended();
  ~Unattended();
  Unattended(const Unattended&) = delete;
  Unattended& operator=(const Unattended&) = delete;
};

/// Returns the context of a command: threads, progress bar and cancellation. `progress` and `interrupt` must outlive
/// it.
[[nodiscard]] Context make_context(int threads, Progress& progress, const Interrupt& interrupt);

}  // namespace blum::cli
