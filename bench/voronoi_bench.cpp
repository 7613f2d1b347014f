// Voronoi complexes of polyhedra: cubes, and what one takes, over shapes of 12 to 2,000 triangles, as made and turned.
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "support/measure.hpp"

namespace blum::bench {
namespace {

/// Turned about two axes, which bends faces of several triangles by rounding.
TriangleMesh turned(TriangleMesh mesh) {
  constexpr double about_z = 0.3;
  constexpr double about_x = 0.5;
  for (Vec3d& p : mesh.vertices) {
    const Vec3d q{std::cos(about_z) * p.x - std::sin(about_z) * p.y, std::sin(about_z) * p.x + std::cos(about_z) * p.y,
                  p.z};
    p = {q.x, std::cos(about_x) * q.y - std::sin(about_x) * q.z, std::sin(about_x) * q.y + std::cos(about_x) * q.z};
  }
  return mesh;
}

void voronoi_case(benchmark::State& state, const TriangleMesh& mesh, int resolution) {
  VoronoiOptions options;
  options.resolution = resolution;
  VoronoiReport found;
  const Times times = time_runs([&] { found = voronoi_complex(mesh, options).report; });
  report(state, times, static_cast<double>(found.cubes));
  report_phases(state, found.phases);
  if (!found.certified) return state.SkipWithError("not certified");
  const auto cubes = static_cast<double>(found.cubes);
  state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
  state.counters["cubes"] = cubes;
  state.counters["ms_per_cube"] = 1e3 * times.wall / cubes;
  state.counters["governors"] = found.governors;
  state.counters["exact_lines"] = static_cast<double>(found.exact_lines);
}

void add_case(const std::string& name, const TriangleMesh& mesh, bool also_turned = true, int resolution = 1) {
  add("voronoi/" + name, [=](benchmark::State& state) { voronoi_case(state, mesh, resolution); });
  if (!also_turned) return;
  add("voronoi/" + name + "/turned",
      [mesh = turned(mesh), resolution](benchmark::State& state) { voronoi_case(state, mesh, resolution); });
}

const bool registered = [] {
  add_case("box", make_box());
  add_case("star", make_star());
  for (const int sides : {16, 64, 256}) {
    add_case("cylinder-" + std::to_string(sides), make_cylinder({.sides = sides}), sides < 256);
  }
  add_case("bracket", make_bracket());
  add_case("plate", make_plate());
  add_case("gear", make_gear(), false);
  add_case("menger-1", make_menger({.level = 1}));
  add_case("menger-2", make_menger({.level = 2}));
  add_case("sphere-4", make_sphere({.frequency = 4}));
  add_case("bracket/resolution-64", make_bracket(), false, 64);
  return true;
}();

}  // namespace
}  // namespace blum::bench
