// Times bands of +-3 voxels: Blum, which writes a dense grid, against OpenVDB, which writes a sparse one.
#include <cmath>

#include "blum/field/field.hpp"
#include "peers/peers.hpp"
#include "support/check.hpp"
#include "support/measure.hpp"
#include "support/shapes.hpp"

namespace blum::bench {
namespace {

constexpr double width = 3;  // voxels

void blum_case(benchmark::State& state, const std::string& name, int n, SignMode sign) {
  const Shape& input = shape(name);
  const GridSpec grid = cube_grid(input.mesh, n);
  Field field;
  const Times times = time_runs([&] {
    field = Field();
    field = distance_field(input.mesh, grid, {.sign = sign, .band = width * grid.spacing.x});
  });
  report(state, times, static_cast<double>(grid.node_count()));
  report_phases(state, field.phases);
  spot_check(state, input, field);
  state.SetLabel(input.note);
}

void openvdb_case(benchmark::State& state, const std::string& name, int n, bool is_signed) {
  const Shape& input = shape(name);
  const GridSpec grid = cube_grid(input.mesh, n);
  std::optional<PeerBand> band;
  std::vector<Times> runs;
  int count = 1;
  while (static_cast<int>(runs.size()) < count) {
    band = openvdb_band(input.mesh, grid, width, is_signed, {});
    if (!band) {
      state.SkipWithError("peer not installed");
      return;
    }
    runs.push_back(band->times);
    count = run_count(band->times.wall);
  }
  report(state, median(runs), static_cast<double>(grid.node_count()));
  state.counters["active_nodes"] = band->active_nodes;
  // OpenVDB's error in voxels is reported, not limited: its bands grow through the triangles of neighbouring voxels.
  double worst = 0;
  for (const BandSample& sample : band->samples) {
    const Vec3d position = grid.position(sample.node[0], sample.node[1], sample.node[2]);
    const double exact = input.brute_force().nearest(position).distance;
    worst = std::max(worst, std::abs(std::abs(sample.distance) - exact) / grid.spacing.x);
  }
  state.counters["checked"] = static_cast<double>(band->samples.size());
  state.counters["worst_error_voxels"] = worst;
  state.SetLabel(input.note);
}

const bool registered = [] {
  for (const std::string name : {"bunny", "fandisk", "organic"}) {
    for (const int n : {256, 512}) {
      const std::string prefix = "band/" + name + "/" + std::to_string(n) + "/";
      add(prefix + "blum", [=](benchmark::State& state) { blum_case(state, name, n, SignMode::none); });
      add(prefix + "openvdb", [=](benchmark::State& state) { openvdb_case(state, name, n, false); });
      if (name == "bunny") continue;  // an open mesh: OpenVDB's inside is meaningless
      add("signed-" + prefix + "blum", [=](benchmark::State& state) { blum_case(state, name, n, SignMode::normals); });
      add("signed-" + prefix + "openvdb", [=](benchmark::State& state) { openvdb_case(state, name, n, true); });
    }
  }
  return true;
}();

}  // namespace
}  // namespace blum::bench
