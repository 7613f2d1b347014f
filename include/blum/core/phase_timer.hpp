// Blum: wall-clock time per phase. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace blum {

/// Wall-clock seconds of one phase of a computation.
struct PhaseTime {
  std::string phase;
  double seconds = 0;
};

/// Stopwatch: lap() appends the time since the previous lap, or since construction, to a list of phases.
class PhaseTimer {
 public:
  explicit PhaseTimer(std::vector<PhaseTime>& phases) : phases_(phases) {}

  void lap(std::string phase) {
    const auto now = std::chrono::steady_clock::now();
    phases_.push_back({std::move(phase), std::chrono::duration<double>(now - start_).count()});
    start_ = now;
  }

 private:
  std::vector<PhaseTime>& phases_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace blum
