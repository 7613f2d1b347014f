// Blum: what benchmarks measure: wall-clock and CPU seconds, medians, load. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>
#include <vector>

#include "blum/field/field.hpp"

namespace blum::bench {

/// Seconds of one run, or medians over several. CPU seconds are those of the whole process, all threads.
struct Times {
  double wall = 0;
  double cpu = 0;
  int runs = 0;
  double load = 0;  ///< the machine's load average over the last minute, before the first run
};

/// CPU seconds that this process has used so far (CLOCK_PROCESS_CPUTIME_ID).
[[nodiscard]] double process_cpu_seconds();
/// The load average over the last minute.
[[nodiscard]] double machine_load();

/// Runs a body once.
[[nodiscard]] Times time_once(const std::function<void()>& body);

/// Medians, of wall and of CPU seconds apart.
[[nodiscard]] Times median(std::vector<Times> runs);

/// How often to run what took `seconds` at first: once above 20 s, 3 times, 5 below 2 s, or 25 below 0.3 s
/// (the first few still touch fresh memory). BLUM_BENCH_RUNS in the
/// environment sets another number.
[[nodiscard]] int run_count(double seconds);

/// Runs a body run_count() times.
[[nodiscard]] Times time_runs(const std::function<void()>& body);

/// Runs two bodies in turn, so that both see the same machine; for the cost of one over the other.
struct TimesOfTwo {
  Times first, second;
};
[[nodiscard]] TimesOfTwo time_in_turn(const std::function<void()>& first, const std::function<void()>& second);

/// Passes times on to Google Benchmark: its iteration time is the wall-clock median; counters wall_s, cpu_s, runs,
/// load, and Mvoxel_per_core_s = nodes / cpu_s / 1e6. `fraction` of the nodes were computed, and times scaled to all.
void report(benchmark::State& state, const Times& times, double nodes, double fraction = 1);
void report_phases(benchmark::State& state, const std::vector<PhaseTime>& phases);

/// Registers a benchmark that measures by itself, once.
void add(const std::string& name, const std::function<void(benchmark::State&)>& body);

}  // namespace blum::bench
