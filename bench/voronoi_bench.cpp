// Times Voronoi complexes of polyhedra and their parts: number of cubes and time per cube. Shapes have 12 to 10,000
// triangles, as generated and rotated. Compares prisms with CGAL's diagrams of their cross-sections, and medial axes
// with those of the grid.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "blum/axis/collapse_axis.hpp"
#include "blum/core/random.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/medial_axis/medial_axis.hpp"
#include "blum/shapes/generators.hpp"
#include "blum/shapes/shape_catalog.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "peers/segment_voronoi.hpp"
#include "support/double_cone.hpp"
#include "support/measure.hpp"

namespace blum::bench {
namespace {

/// Rotates a mesh about two axes. Rounding bends faces of several triangles.
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

void add_case(const std::string& name, const TriangleMesh& mesh,
              const VoronoiOptions& options = {.method = VoronoiMethod::cubes, .resolution = 1},
              bool also_turned = true) {
  add("voronoi/" + name, [=](benchmark::State& state) { voronoi_case(state, mesh, options); });
  if (!also_turned) return;
  add("voronoi/" + name + "/turned",
      [mesh = turned(mesh), options](benchmark::State& state) { voronoi_case(state, mesh, options); });
}

/// The exact diagram of a convex solid, and for comparison the one divided into cubes.
void convex_case(const std::string& name, const TriangleMesh& mesh, bool also_cubes = true) {
  const auto run = [](benchmark::State& state, const TriangleMesh& of, VoronoiMethod method) {
    VoronoiReport found;
    // The default flatness does not join the ends of turned cylinders of many sides.
    const VoronoiOptions options{.part = VoronoiPart::walls, .method = method, .flatness = 1e-12, .resolution = 1};
    const Times times = time_runs([&] { found = voronoi_complex(of, options).report; });
    report(state, times, static_cast<double>(found.faces));
    report_phases(state, found.phases);
    if (!found.certified) return state.SkipWithError("not certified");
    if (found.exact != (method == VoronoiMethod::automatic)) return state.SkipWithError("another method");
    state.counters["triangles"] = static_cast<double>(of.triangles.size());
    state.counters["faces"] = static_cast<double>(found.faces);
  };
  for (const bool is_turned : {false, true}) {
    const std::string full_name = "convex/" + name + (is_turned ? "/turned" : "");
    const TriangleMesh placed = is_turned ? turned(mesh) : mesh;
    add(full_name, [=](benchmark::State& state) { run(state, placed, VoronoiMethod::automatic); });
    if (!also_cubes) continue;
    add(full_name + "/cubes", [=](benchmark::State& state) { run(state, placed, VoronoiMethod::cubes); });
  }
}

/// Medial axes from exact walls and from the grid, at one angle.
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

/// A counterclockwise polygon around the origin, with reflex corners. No point is equally far from four sites.
std::vector<Point2> random_polygon(std::size_t corners) {
  Random random(7);
  std::vector<Point2> out;
  for (std::size_t k = 0; k < corners; ++k) {
    const double angle =
        2 * std::numbers::pi * (static_cast<double>(k) + 0.5 * random.uniform()) / static_cast<double>(corners);
    const double radius = random.uniform(0.6, 1);
    out.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  return out;
}

/// Pairs of sides and corners of a polygon that share a wall in the middle half of a prism over it. SegmentVoronoiEdge
/// defines their numbers.
std::set<std::array<std::uint32_t, 2>> walls_of_prism(const TriangleMesh& mesh, const std::vector<Point2>& polygon,
                                                      const Complex& walls, double height) {
  const auto count = static_cast<std::uint32_t>(polygon.size());
  const auto corner_at = [&](const Vec3d& p) {
    const auto at = std::find(polygon.begin(), polygon.end(), Point2{p.x, p.y});
    return static_cast<std::uint32_t>(at - polygon.begin());
  };
  const SiteTable table(mesh);
  const PolyhedronSites sites = polyhedron_sites(mesh, table);
  std::map<std::int32_t, std::uint32_t> number;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::set<std::uint32_t> corners;
    for (const std::uint32_t v : mesh.triangles[t]) corners.insert(corner_at(mesh.vertices[v]));
    if (corners.size() != 2) continue;
    const bool is_last = *corners.begin() == 0 && *corners.rbegin() + 1 == count && count > 2;
    number[static_cast<std::int32_t>(sites.face_of[t])] = is_last ? count - 1 : *corners.begin();
  }
  for (std::size_t k = 0; k < sites.reflex_edges.size(); ++k) {
    const Segment& ends = table.edges()[sites.reflex_edges[k]];
    number[static_cast<std::int32_t>(sites.face_count + k)] = count + corner_at(mesh.vertices[ends[0]]);
  }
  std::set<std::array<std::uint32_t, 2>> out;
  const auto site_a = walls.triangle_columns.get<std::int32_t>("site_a");
  const auto site_b = walls.triangle_columns.get<std::int32_t>("site_b");
  for (std::size_t t = 0; t < walls.triangles.size(); ++t) {
    double z = 0;
    for (const std::uint32_t v : walls.triangles[t]) z += walls.positions[v].z / 3;
    if (std::abs(z) > height / 4) continue;
    const auto [low, high] = std::minmax({number.at(site_a[t]), number.at(site_b[t])});
    out.insert({low, high});
  }
  return out;
}

/// Compares the Voronoi diagram of a prism with CGAL's diagram of its cross-section. All pairs of sites that share a
/// wall of the prism must be pairs of CGAL. Each of CGAL's pairs must share a wall if its edge is longer than a cube.
void prism_cases(std::size_t corners) {
  const std::vector<Point2> polygon = random_polygon(corners);
  constexpr double height = 4;
  const TriangleMesh mesh = make_extrusion(polygon, {}, {.thickness = height});
  const std::string name = "prism/" + std::to_string(corners);
  add(name + "/blum", [=](benchmark::State& state) {
    const VoronoiOptions options{.part = VoronoiPart::walls};
    voronoi_case(state, mesh, options);
    const auto peer = cgal_segment_voronoi(polygon);
    if (!peer) return;
    const VoronoiComplex walls = voronoi_complex(mesh, {.part = VoronoiPart::walls, .resolution = 64});
    const auto own = walls_of_prism(mesh, polygon, walls.complex, height);
    std::set<std::array<std::uint32_t, 2>> theirs;
    std::size_t missing = 0;
    for (const SegmentVoronoiEdge& edge : peer->edges) {
      theirs.insert(edge.sites);
      if (edge.length > walls.report.hausdorff_bound && !own.contains(edge.sites)) ++missing;
    }
    const bool is_subset = std::includes(theirs.begin(), theirs.end(), own.begin(), own.end());
    state.counters["walls"] = static_cast<double>(own.size());
    state.counters["walls_of_cgal"] = static_cast<double>(theirs.size());
    if (missing > 0 || !is_subset) state.SkipWithError("the cross-section differs from CGAL's diagram");
  });
  add(name + "/cgal-2d", [=](benchmark::State& state) {
    const auto peer = cgal_segment_voronoi(polygon);
    if (!peer) return state.SkipWithError("CGAL is not installed");
    report(state, peer->times, static_cast<double>(polygon.size()));
  });
}

const bool registered = [] {
  convex_case("box", make_box());
  for (const int sides : {16, 256}) {
    convex_case("cylinder-" + std::to_string(sides), make_cylinder({.sides = sides}));
  }
  for (const int frequency : {4, 8, 16, 32}) {
    convex_case("sphere-" + std::to_string(frequency), make_sphere({.frequency = frequency}), frequency == 4);
  }
  convex_case("double-cone-1000", test::double_cone(1000), false);
  add_case("box", make_box());
  add_case("star", make_star());
  for (const int sides : {16, 64, 256}) {
    add_case("cylinder-" + std::to_string(sides), make_cylinder({.sides = sides}));
  }
  add_case("bracket", make_bracket());
  add_case("plate", make_plate());
  add_case("gear", make_gear());
  add_case("menger-1", make_menger({.level = 1}));
  add_case("menger-2", make_menger({.level = 2}));
  add_case("menger-3", make_menger({.level = 3}), {.resolution = 1}, false);
  add_case("gear-200", make_gear({.teeth = 200}), {.resolution = 1}, false);
  add_case("sphere-4", make_sphere({.frequency = 4}));
  add_case("bracket/resolution-64", make_bracket(), {.resolution = 64}, false);
  for (const VoronoiPart part : {VoronoiPart::walls, VoronoiPart::medial_axis}) {
    const std::string name = part == VoronoiPart::walls ? "walls" : "medial";
    add_case("bracket/" + name, make_bracket(), {.part = part, .resolution = 1});
    add_case("menger-2/" + name, make_menger({.level = 2}), {.part = part, .resolution = 1});
  }
  for (const std::size_t corners : {16U, 64U, 256U}) prism_cases(corners);
  axis_cases("bracket", make_bracket());
  axis_cases("gear", make_gear());
  return true;
}();

}  // namespace
}  // namespace blum::bench
