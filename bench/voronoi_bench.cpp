// Voronoi complexes of polyhedra and their parts: cubes, and what one takes, over shapes of 12 to 2,000 triangles, as
// made and turned; medial axes from them beside those of the grid.
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "blum/medial_axis/collapse_axis.hpp"
#include "blum/medial_axis/medial_axis.hpp"
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

void voronoi_case(benchmark::State& state, const TriangleMesh& mesh, const VoronoiOptions& options) {
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

void add_case(const std::string& name, const TriangleMesh& mesh, const VoronoiOptions& options = {.resolution = 1},
              bool also_turned = true) {
  add("voronoi/" + name, [=](benchmark::State& state) { voronoi_case(state, mesh, options); });
  if (!also_turned) return;
  add("voronoi/" + name + "/turned",
      [mesh = turned(mesh), options](benchmark::State& state) { voronoi_case(state, mesh, options); });
}

/// The medial axis by exact walls, and that of the grid, at one angle.
void axis_cases(const std::string& name, const TriangleMesh& mesh) {
  constexpr double theta = 60;
  add("axis/" + name + "/walls", [=](benchmark::State& state) {
    std::size_t triangles = 0;
    const Times times = time_runs([&] {
      const VoronoiComplex walls = voronoi_complex(mesh, {.part = VoronoiPart::medial_axis});
      triangles = collapse_axis(walls.complex, theta).triangles.size();
    });
    report(state, times, static_cast<double>(triangles));
  });
  add("axis/" + name + "/grid", [=](benchmark::State& state) {
    std::size_t triangles = 0;
    const Times times = time_runs([&] {
      const MedialAxis axis = medial_axis(mesh, {.least_theta = theta, .greatest_theta = theta});
      triangles = axis.fitted(theta).triangles.size();
    });
    report(state, times, static_cast<double>(triangles));
  });
}

const bool registered = [] {
  add_case("box", make_box());
  add_case("star", make_star());
  for (const int sides : {16, 64, 256}) {
    add_case("cylinder-" + std::to_string(sides), make_cylinder({.sides = sides}), {.resolution = 1}, sides < 256);
  }
  add_case("bracket", make_bracket());
  add_case("plate", make_plate());
  add_case("gear", make_gear());
  add_case("menger-1", make_menger({.level = 1}));
  add_case("menger-2", make_menger({.level = 2}));
  add_case("sphere-4", make_sphere({.frequency = 4}));
  add_case("bracket/resolution-64", make_bracket(), {.resolution = 64}, false);
  for (const VoronoiPart part : {VoronoiPart::walls, VoronoiPart::medial_axis}) {
    const std::string name = part == VoronoiPart::walls ? "walls" : "medial";
    add_case("bracket/" + name, make_bracket(), {.part = part, .resolution = 1});
    add_case("menger-2/" + name, make_menger({.level = 2}), {.part = part, .resolution = 1});
  }
  axis_cases("bracket", make_bracket());
  axis_cases("gear", make_gear());
  return true;
}();

}  // namespace
}  // namespace blum::bench
