// Times cellular models of solids for several resolutions and numbers of triangles. Also reports nanoseconds per cube
// that the surface cuts.
#include <string>

#include "blum/solid/solid.hpp"
#include "support/measure.hpp"
#include "support/shapes.hpp"

namespace blum::bench {
namespace {

void model_case(benchmark::State& state, const std::string& name, int resolution) {
  const Shape& shape_of = shape(name);
  const Solid solid = Solid::of(shape_of.mesh);
  if (solid.rule() != SolidRule::polyhedron) {
    state.SkipWithError(solid.reason().c_str());
    return;
  }
  CellularModelReport facts;
  const Times times = time_runs([&] { facts = solid.model({.resolution = resolution}).report(); });
  const auto cut = static_cast<double>(facts.cut_cubes);
  report(state, times, cut);
  state.counters["triangles"] = static_cast<double>(shape_of.mesh.triangles.size());
  state.counters["cut_cubes"] = cut;
  state.counters["boxes"] = static_cast<double>(facts.boxes);
  state.counters["cpu_ns_per_cut_cube"] = 1e9 * times.cpu / cut;
  state.counters["passes"] = facts.passes ? 1 : 0;
  state.SetLabel(shape_of.note);
}

const bool registered = [] {
  for (const int resolution : {32, 64, 128, 256, 512}) {
    add("model/rocker-arm/" + std::to_string(resolution),
        [=](benchmark::State& state) { model_case(state, "rocker-arm", resolution); });
  }
  for (const std::string triangles : {"20000", "100000", "400000", "1600000"}) {
    add("model/organic-" + triangles + "/256",
        [=](benchmark::State& state) { model_case(state, "organic-" + triangles, 256); });
  }
  return true;
}();

}  // namespace
}  // namespace blum::bench
