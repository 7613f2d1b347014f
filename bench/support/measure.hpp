// Blum: measurements of benchmarks: wall-clock and CPU seconds, medians, load. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>
#include <vector>

#include "blum/field/field.hpp"

namespace blum::bench {

/// Seconds of one run, or medians over several runs. CPU seconds cover the whole process with all threads.
struct Times {
  double wall = 0;
  double cpu = 0;
  int runs = 0;
  double load = 0;  ///< load average of the machine over the minute before the first run
};

/// CPU seconds of this process so far (CLOCK_PROCESS_CPUTIME_ID).
[[nodiscard]] double process_cpu_seconds();
/// The load average over the last minute.
[[nodiscard]] double machine_load();

/// Runs a function once.
[[nodiscard]] Times time_once(const std::function<void()>& body);

/// Medians of wall-clock seconds and of CPU seconds, each by itself.
[[nodiscard]] Times median(std::vector<Times> runs);

/// The number of runs if the first one took `seconds`: 1 above 20 s, 3 above 2 s, 5 above 0.3 s, else 25. The first few
/// still touch fresh memory. The environment variable BLUM_BENCH_RUNS sets another number.
[[nodiscard]] int run_count(double seconds);

/// Runs a function run_count() times.
[[nodiscard]] Times time_runs(const std::function<void()>& body);

/// Times of two functions that run in turn, so that other work on the machine affects both alike.
struct TimesOfTwo {
  Times first, second;
};
[[nodiscard]] TimesOfTwo time_in_turn(const std::function<void()>& first, const std::function<void()>& second);

/// Reports times to Google Benchmark. The iteration time is the wall-clock median. Counters are wall_s, cpu_s, runs,
/// load, and Mvoxel_per_core_s = nodes / cpu_s / 1e6. `fraction` of the nodes were computed; times are scaled to all.
void report(benchmark::State& state, const Times& times, double nodes, double fraction = 1);
void report_phases(benchmark::State& state, const std::vector<PhaseTime>& phases);

/// Registers a benchmark that runs once and measures its own time.
void add(const std::string& name, const std::function<void(benchmark::State&)>& body);

}  // namespace blum::bench
