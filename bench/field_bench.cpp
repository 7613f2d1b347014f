// Times unsigned distances and closest sites on the full grid: Blum against Embree and CGAL on the same mesh and grid.
// Also compares one thread with two, and instruction sets with each other.
#include "blum/field/field.hpp"
#include "field/cpu/tile_kernel.hpp"
#include "peers/peers.hpp"
#include "support/check.hpp"
#include "support/measure.hpp"
#include "support/shapes.hpp"

namespace blum::bench {
namespace {

void blum_case(benchmark::State& state, const std::string& name, int n, int threads) {
  const Shape& input = shape(name);
  const GridSpec grid = cube_grid(input.mesh, n);
  Field field;
  const Times times = time_runs([&] {
    field = Field();
    field = distance_field(input.mesh, grid, {.sign = SignMode::none}, {.threads = threads});
  });
  report(state, times, static_cast<double>(grid.node_count()));
  report_phases(state, field.phases);
  spot_check(state, input, field);
  state.SetLabel(input.note);
}

using Peer = std::optional<PeerField> (*)(const MeshView&, const GridSpec&, const Context&);

void peer_case(benchmark::State& state, const std::string& name, int n, Peer peer) {
  const Shape& input = shape(name);
  const GridSpec grid = cube_grid(input.mesh, n);
  std::vector<Times> runs;
  std::optional<PeerField> result;
  int count = 1;
  while (static_cast<int>(runs.size()) < count) {
    result.reset();
    result = peer(input.mesh, grid, {});
    if (!result) {
      state.SkipWithError("peer not installed");
      return;
    }
    runs.push_back(result->times);
    count = std::min(3, run_count(result->times.wall * result->fraction));
  }
  report(state, median(runs), static_cast<double>(grid.node_count()), result->fraction);
  state.counters["phase build"] = result->build_wall;
  state.counters["build_cpu_s"] = result->build_cpu;
  // The peers use single precision, about six digits.
  spot_check(state, input, result->field, 1e-5);
  state.SetLabel(input.note);
}

void add_cases(const std::string& name, std::initializer_list<int> sizes) {
  for (const int n : sizes) {
    const std::string prefix = "field/" + name + "/" + std::to_string(n) + "/";
    add(prefix + "blum", [=](benchmark::State& state) { blum_case(state, name, n, 0); });
    add(prefix + "embree", [=](benchmark::State& state) { peer_case(state, name, n, embree_field); });
    add(prefix + "cgal", [=](benchmark::State& state) { peer_case(state, name, n, cgal_field); });
  }
}

/// Runs one thread and two threads in turn, so that other work on the machine disturbs both alike.
void thread_case(benchmark::State& state, const std::string& name, int n) {
  const Shape& input = shape(name);
  const GridSpec grid = cube_grid(input.mesh, n);
  const auto with = [&](int threads) {
    return [&, threads] {
      Field field = distance_field(input.mesh, grid, {.sign = SignMode::none}, {.threads = threads});
      benchmark::DoNotOptimize(field.distance.data());
    };
  };
  const TimesOfTwo times = time_in_turn(with(1), with(2));
  report(state, times.second, static_cast<double>(grid.node_count()));
  state.counters["one_wall_s"] = times.first.wall;
  state.counters["one_cpu_s"] = times.first.cpu;
  state.SetLabel(input.note);
}

void simd_case(benchmark::State& state, const std::string& name, int n, const std::string& target) {
  const Shape& input = shape(name);
  const GridSpec grid = cube_grid(input.mesh, n);
  const auto run = [&](const std::string& set) {
    return [&, set] {
      cpu::use_simd_target(set);
      Field field = distance_field(input.mesh, grid, {.sign = SignMode::none});
      benchmark::DoNotOptimize(field.distance.data());
    };
  };
  const TimesOfTwo times = time_in_turn(run(""), run(target));
  cpu::use_simd_target("");
  report(state, times.second, static_cast<double>(grid.node_count()));
  state.counters["best_wall_s"] = times.first.wall;
  state.counters["best_cpu_s"] = times.first.cpu;
  state.SetLabel(input.note + ", against " + cpu::simd_targets().front());
}

/// Runs first and second sites of every node, and first sites alone, in turn, on one thread.
void second_case(benchmark::State& state, const std::string& name, int n, SignMode sign) {
  const Shape& input = shape(name);
  const GridSpec grid = cube_grid(input.mesh, n);
  const auto with = [&](int order) {
    return [&, order] {
      Field field = distance_field(input.mesh, grid, {.sign = sign, .order = order}, {.threads = 1});
      benchmark::DoNotOptimize(field.distance.data());
    };
  };
  const TimesOfTwo times = time_in_turn(with(1), with(2));
  report(state, times.second, static_cast<double>(grid.node_count()));
  state.counters["first_wall_s"] = times.first.wall;
  state.counters["first_cpu_s"] = times.first.cpu;
  state.counters["wall_ratio"] = times.second.wall / times.first.wall;
  state.counters["cpu_ratio"] = times.second.cpu / times.first.cpu;
  state.SetLabel(input.note);
}

const bool registered = [] {
  add_cases("bunny", {64, 128, 256, 512});
  add_cases("fandisk", {64, 128, 256, 512});
  add_cases("noisy-1.6M", {128, 256, 512});
  for (const char* name : {"bunny", "fandisk"}) {
    const std::string shape_name = name;
    add("threads/" + shape_name + "/256/blum", [=](benchmark::State& state) { thread_case(state, shape_name, 256); });
    for (const int n : {128, 256}) {
      for (const SignMode sign : {SignMode::none, SignMode::automatic}) {
        const std::string kind = sign == SignMode::none ? "unsigned" : "signed";
        add("second/" + shape_name + "/" + std::to_string(n) + "/" + kind,
            [=](benchmark::State& state) { second_case(state, shape_name, n, sign); });
      }
    }
    for (const std::string& target : cpu::simd_targets()) {
      add("simd/" + shape_name + "/256/" + target,
          [=](benchmark::State& state) { simd_case(state, shape_name, 256, target); });
    }
  }
  return true;
}();

}  // namespace
}  // namespace blum::bench
