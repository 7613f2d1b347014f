#include "support/measure.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>

namespace blum::bench {
namespace {

double middle(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace

double process_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double machine_load() {
  double load = 0;
  return getloadavg(&load, 1) == 1 ? load : 0;
}

Times time_once(const std::function<void()>& body) {
  Times times{.runs = 1, .load = machine_load()};
  const auto wall = std::chrono::steady_clock::now();
  const double cpu = process_cpu_seconds();
  body();
  times.cpu = process_cpu_seconds() - cpu;
  times.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count();
  return times;
}

Times median(std::vector<Times> runs) {
  std::vector<double> wall;
  std::vector<double> cpu;
  for (const Times& run : runs) {
    wall.push_back(run.wall);
    cpu.push_back(run.cpu);
  }
  return {middle(wall), middle(cpu), static_cast<int>(runs.size()), runs.front().load};
}

int run_count(double seconds) {
  if (const char* asked = std::getenv("BLUM_BENCH_RUNS")) return std::max(1, std::atoi(asked));
  return seconds > 20 ? 1 : seconds > 2 ? 3 : seconds > 0.3 ? 5 : 25;
}

Times time_runs(const std::function<void()>& body) {
  std::vector<Times> runs{time_once(body)};
  const int count = run_count(runs[0].wall);
  while (static_cast<int>(runs.size()) < count) runs.push_back(time_once(body));
  return median(std::move(runs));
}

TimesOfTwo time_in_turn(const std::function<void()>& first, const std::function<void()>& second) {
  std::vector<Times> of_first{time_once(first)};
  std::vector<Times> of_second{time_once(second)};
  const int count = run_count(std::max(of_first[0].wall, of_second[0].wall));
  while (static_cast<int>(of_first.size()) < count) {
    of_first.push_back(time_once(first));
    of_second.push_back(time_once(second));
  }
  return {median(std::move(of_first)), median(std::move(of_second))};
}

void report(benchmark::State& state, const Times& times, double nodes, double fraction) {
  state.SetIterationTime(times.wall);
  state.counters["wall_s"] = times.wall;
  state.counters["cpu_s"] = times.cpu;
  state.counters["runs"] = times.runs;
  state.counters["load"] = times.load;
  state.counters["nodes"] = nodes;
  state.counters["fraction"] = fraction;
  state.counters["Mvoxel_per_core_s"] = nodes / times.cpu / 1e6;
}

void report_phases(benchmark::State& state, const std::vector<PhaseTime>& phases) {
  for (const PhaseTime& phase : phases) state.counters["phase " + phase.phase] = phase.seconds;
}

void add(const std::string& name, const std::function<void(benchmark::State&)>& body) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [body](benchmark::State& state) {
                                 for ([[maybe_unused]] auto iteration : state) body(state);
                               })
      ->Iterations(1)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

}  // namespace blum::bench
