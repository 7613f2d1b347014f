// Times fields for several numbers of nodes and triangles. The floor is the time to write 8 bytes per node.
#include <cstdint>

#include "blum/core/parallel.hpp"
#include "blum/field/field.hpp"
#include "support/check.hpp"
#include "support/measure.hpp"
#include "support/shapes.hpp"

namespace blum::bench {
namespace {

void field_case(benchmark::State& state, const std::string& name, int n) {
  const Shape& input = shape(name);
  const GridSpec grid = cube_grid(input.mesh, n);
  Field field;
  const Times times = time_runs([&] {
    field = Field();
    field = distance_field(input.mesh, grid, {.sign = SignMode::none});
  });
  report(state, times, static_cast<double>(grid.node_count()));
  report_phases(state, field.phases);
  state.counters["triangles"] = static_cast<double>(input.mesh.triangles.size());
  spot_check(state, input, field);
  state.SetLabel(input.note);
}

/// Writes a float and an id per node, to new memory as for a first field, or to memory that was written before.
void floor_case(benchmark::State& state, int n, bool fresh) {
  const std::size_t nodes = static_cast<std::size_t>(n) * static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
  Buffer<float> distance;
  Buffer<std::uint32_t> site;
  const auto write = [&] {
    if (fresh) {
      distance = Buffer<float>();
      site = Buffer<std::uint32_t>();
    }
    if (distance.empty()) {
      distance = Buffer<float>(nodes);
      site = Buffer<std::uint32_t>(nodes);
    }
    parallel_for({}, nodes, std::size_t{1} << 18, "", [&](const WorkRange& range) {
      for (std::size_t i = range.begin; i < range.end; ++i) distance[i] = 1;
      for (std::size_t i = range.begin; i < range.end; ++i) site[i] = 1;
    });
    benchmark::DoNotOptimize(distance.data());
    benchmark::ClobberMemory();
  };
  if (!fresh) write();
  report(state, time_runs(write), static_cast<double>(nodes));
}

const bool registered = [] {
  for (const std::string name : {"bunny", "fandisk"}) {
    for (const int n : {64, 96, 128, 192, 256, 384, 512, 640}) {
      add("nodes/" + name + "/" + std::to_string(n) + "/blum",
          [=](benchmark::State& state) { field_case(state, name, n); });
    }
  }
  for (const std::string triangles : {"1000", "4000", "16000", "64000", "256000", "1000000", "4000000"}) {
    for (const int n : {128, 256}) {
      add("triangles/organic-" + triangles + "/" + std::to_string(n) + "/blum",
          [=](benchmark::State& state) { field_case(state, "organic-" + triangles, n); });
    }
  }
  for (const int n : {128, 256, 512}) {
    const std::string size = std::to_string(n);
    add("floor/new-memory/" + size + "/write", [=](benchmark::State& state) { floor_case(state, n, true); });
    add("floor/used-memory/" + size + "/write", [=](benchmark::State& state) { floor_case(state, n, false); });
  }
  return true;
}();

}  // namespace
}  // namespace blum::bench
