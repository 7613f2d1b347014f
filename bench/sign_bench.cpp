// Times signed fields against unsigned ones, and winding numbers against one query per node.
#include "blum/field/field.hpp"
#include "peers/peers.hpp"
#include "support/check.hpp"
#include "support/measure.hpp"
#include "support/shapes.hpp"

namespace blum::bench {
namespace {

/// Runs signed and unsigned fields in turn. Counters unsigned_*: seconds of the unsigned field.
void sign_case(benchmark::State& state, const std::string& name, int n, SignMode sign) {
  const Shape& input = shape(name);
  const GridSpec grid = cube_grid(input.mesh, n);
  Field field;
  const auto with = [&](SignMode mode) {
    return [&, mode] {
      field = Field();
      field = distance_field(input.mesh, grid, {.sign = mode});
    };
  };
  const TimesOfTwo times = time_in_turn(with(SignMode::none), with(sign));
  report(state, times.second, static_cast<double>(grid.node_count()));
  report_phases(state, field.phases);
  state.counters["unsigned_wall_s"] = times.first.wall;
  state.counters["unsigned_cpu_s"] = times.first.cpu;
  spot_check(state, input, field);
  state.SetLabel(input.note);
}

void query_case(benchmark::State& state, const std::string& name, int n) {
  const Shape& input = shape(name);
  const GridSpec grid = cube_grid(input.mesh, n);
  std::vector<Times> runs;
  double fraction = 1;
  for (int run = 0; run < 3; ++run) {
    const PeerField result = winding_queries(input.mesh, grid, {});
    fraction = result.fraction;
    runs.push_back(result.times);
  }
  report(state, median(runs), static_cast<double>(grid.node_count()), fraction);
  state.SetLabel(input.note);
}

const bool registered = [] {
  for (const std::string name : {"fandisk", "organic"}) {
    for (const int n : {128, 256}) {
      const std::string size = "/" + std::to_string(n) + "/";
      add("sign-normals/" + name + size + "blum",
          [=](benchmark::State& state) { sign_case(state, name, n, SignMode::normals); });
      add("sign-winding/" + name + size + "blum",
          [=](benchmark::State& state) { sign_case(state, name, n, SignMode::winding); });
    }
  }
  for (const int n : {128, 256}) {
    const std::string size = std::to_string(n);
    add("sign-winding/bunny/" + size + "/blum",
        [=](benchmark::State& state) { sign_case(state, "bunny", n, SignMode::winding); });
    add("sign-winding/bunny/" + size + "/query-per-node",
        [=](benchmark::State& state) { query_case(state, "bunny", n); });
  }
  return true;
}();

}  // namespace
}  // namespace blum::bench
