// Times proximity of two bodies of 100,000 triangles each, and of one body with itself: Blum and peers on the same
// input. Cases use one thread, unless their names state a number.
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blum/proximity/scene.hpp"
#include "blum/shapes/generators.hpp"
#include "peers/collisions.hpp"
#include "support/measure.hpp"

namespace blum::bench {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

Context with_threads(int threads) {
  Context context;
  context.threads = threads;
  return context;
}

/// Two bodies of unit size.
struct Bodies {
  TriangleMesh first = body(1);
  TriangleMesh second = body(2);

  static TriangleMesh body(std::uint64_t seed) {
    TriangleMesh mesh = make_organic({.frequency = 71, .seed = seed});
    const Box3 box = bounds(mesh);
    const Vec3d size = box.size();
    const double scale = 1 / std::max({size.x, size.y, size.z});
    for (Vec3d& p : mesh.vertices) p = (p - box.center()) * scale;
    return mesh;
  }
};

const Bodies& bodies() {
  static const Bodies both;
  return both;
}

RigidTransform turned(double angle, Vec3d axis) {
  axis = axis / length(axis);
  RigidTransform out;
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3d e;
    e[k] = 1;
    out.rotation.columns[k] =
        e * std::cos(angle) + cross(axis, e) * std::sin(angle) + axis * (dot(axis, e) * (1 - std::cos(angle)));
  }
  return out;
}

/// Ten orientations of the second body, each moved along x to about the given distance from the first body.
std::vector<RigidTransform> poses(double gap) {
  ProximityScene scene;
  const ObjectId first = scene.add(bodies().first);
  const ObjectId second = scene.add(bodies().second);
  std::vector<RigidTransform> out;
  for (int k = 0; k < 10; ++k) {
    RigidTransform place = turned(0.6 * k, {1, 0.3 * k, 0.5});
    double low = 0;
    double high = 3;
    for (int step = 0; step < 14; ++step) {
      const double middle = (low + high) / 2;
      place.translation = {middle, 0.1, 0.05};
      scene.update(second, place);
      (scene.separation(first, second)->between.distance > gap ? high : low) = middle;
    }
    place.translation.x = high;
    out.push_back(place);
  }
  return out;
}

void tell(benchmark::State& state, const Times& times, double items) {
  report(state, times, items);
  state.counters["ms"] = times.wall * 1e3 / items;
}

/// Bodies of constant shape: the mean over ten poses.
void rigid_case(benchmark::State& state, double gap, bool is_fcl) {
  const std::vector<RigidTransform> places = poses(gap);
  const Context one = with_threads(1);
  double sum = 0;
  if (is_fcl) {
    const auto fcl = fcl_bodies(bodies().first, bodies().second, FclBodies::oriented);
    if (!fcl) return state.SkipWithError("FCL is not installed");
    const Times times = time_runs([&] {
      sum = 0;
      for (const RigidTransform& place : places) sum += fcl->separation(place);
    });
    tell(state, times, 10);
  } else {
    ProximityScene scene;
    const ObjectId first = scene.add(bodies().first);
    const ObjectId second = scene.add(bodies().second);
    const Times times = time_runs([&] {
      sum = 0;
      for (const RigidTransform& place : places) {
        scene.update(second, place);
        sum += scene.separation(first, second, infinite, one)->between.distance;
      }
    });
    tell(state, times, 10);
  }
  state.counters["mean_distance"] = sum / 10;
}

void deform(const TriangleMesh& rest, double time, const Vec3d& place, TriangleMesh& moved) {
  for (std::size_t v = 0; v < rest.vertices.size(); ++v) {
    const Vec3d& p = rest.vertices[v];
    const double angle = 0.2 * std::sin(3 * p.z + 6 * time);
    moved.vertices[v] = {std::cos(angle) * p.x - std::sin(angle) * p.y, std::sin(angle) * p.x + std::cos(angle) * p.y,
                         p.z};
    moved.vertices[v] += place;
  }
}

/// A program that keeps two deforming bodies between frames.
struct Deforming {
  virtual ~Deforming() = default;
  virtual double frame(const TriangleMesh& first, const TriangleMesh& second) = 0;
};

struct BlumDeforming : Deforming {
  explicit BlumDeforming(int threads) : context(with_threads(threads)) {
    first_id = scene.add(bodies().first);
    second_id = scene.add(bodies().second);
  }
  double frame(const TriangleMesh& first, const TriangleMesh& second) override {
    scene.update(first_id, first.vertices, context);
    scene.update(second_id, second.vertices, context);
    return scene.separation(first_id, second_id, infinite, context)->between.distance;
  }
  ProximityScene scene;
  ObjectId first_id, second_id;
  Context context;
};

struct FclDeforming : Deforming {
  explicit FclDeforming(FclBodies kind) : bodies_of_fcl(fcl_bodies(bodies().first, bodies().second, kind)) {}
  double frame(const TriangleMesh& first, const TriangleMesh& second) override {
    bodies_of_fcl->deform(first, second);
    return bodies_of_fcl->separation({});
  }
  std::unique_ptr<PeerBodies> bodies_of_fcl;
};

/// Both bodies deform for ten frames. A frame includes all work from moved vertices to the distance.
template <class Keeper, class... Arguments>
void deforming_case(benchmark::State& state, Arguments... arguments) {
  Keeper keeper(arguments...);
  std::array<TriangleMesh, 10> first, second;
  for (int k = 0; k < 10; ++k) {
    first[static_cast<std::size_t>(k)] = bodies().first;
    second[static_cast<std::size_t>(k)] = bodies().second;
    deform(bodies().first, 0.1 * k, {}, first[static_cast<std::size_t>(k)]);
    deform(bodies().second, 0.1 * k + 0.5, {1.2, 0.1, 0.05}, second[static_cast<std::size_t>(k)]);
  }
  double sum = 0;
  const Times times = time_runs([&] {
    sum = 0;
    for (std::size_t k = 0; k < 10; ++k) sum += keeper.frame(first[k], second[k]);
  });
  tell(state, times, 10);
  state.counters["mean_distance"] = sum / 10;
}

void self_case(benchmark::State& state, int threads) {
  ProximityScene scene;
  scene.add(bodies().first, {.self = true});
  std::size_t pairs = 0;
  const Context context = with_threads(threads);
  tell(state, time_runs([&] { pairs = scene.collisions(context).pairs.size(); }), 1);
  state.counters["pairs"] = static_cast<double>(pairs);
}

/// A new scene for one frame: building and collisions.
void self_anew_case(benchmark::State& state) {
  std::size_t pairs = 0;
  const Context one = with_threads(1);
  const Times times = time_runs([&] {
    ProximityScene scene;
    scene.add(bodies().first, {.self = true}, one);
    pairs = scene.collisions(one).pairs.size();
  });
  tell(state, times, 1);
  state.counters["pairs"] = static_cast<double>(pairs);
}

void cgal_self_case(benchmark::State& state) {
  decltype(cgal_self_intersections(bodies().first)) pairs;
  const Times times = time_runs([&] { pairs = cgal_self_intersections(bodies().first); });
  if (!pairs) return state.SkipWithError("CGAL is not installed");
  tell(state, times, 1);
  state.counters["pairs"] = static_cast<double>(pairs->size());
}

/// The first body, deformed so that it crosses itself. Waves as long as a fifth of the body displace its points.
TriangleMesh crumpled(double height) {
  TriangleMesh mesh = bodies().first;
  for (Vec3d& p : mesh.vertices) {
    p += Vec3d{std::sin(31 * p.y + 3 * p.z), std::sin(29 * p.z + 5 * p.x), std::sin(37 * p.x + 2 * p.y)} * height;
  }
  return mesh;
}

/// Both bodies in one mesh, overlapping.
TriangleMesh joined_bodies() {
  TriangleMesh mesh = bodies().first;
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3d& p : bodies().second.vertices) mesh.vertices.push_back(p + Vec3d{0.05, 0.02, 0.01});
  for (const auto& [a, b, c] : bodies().second.triangles) mesh.triangles.push_back({base + a, base + b, base + c});
  return mesh;
}

/// A mesh that crosses itself. Blum and CGAL must find the same pairs.
void crossing_case(benchmark::State& state, const TriangleMesh& mesh) {
  const auto expected = cgal_self_intersections(mesh);
  if (!expected) return state.SkipWithError("CGAL is not installed");
  ProximityScene scene;
  scene.add(mesh, {.self = true});
  std::vector<PrimitivePair> found;
  tell(state, time_runs([&] { found = scene.collisions(with_threads(1)).pairs; }), 1);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (const PrimitivePair& pair : found) pairs.emplace_back(pair.first, pair.second);
  state.counters["pairs"] = static_cast<double>(pairs.size());
  state.counters["pairs_of_cgal"] = static_cast<double>(expected->size());
  if (pairs != *expected) state.SkipWithError("Blum and CGAL find other pairs");
}

void n_body_case(benchmark::State& state, int threads) {
  ProximityScene scene;
  scene.add(bodies().first, {.self = true});
  ProximityPairs found;
  const Context context = with_threads(threads);
  tell(state, time_runs([&] { found = scene.closest_primitives(infinite, context); }), 1);
  state.counters["pairs"] = static_cast<double>(found.pairs.size());
  state.counters["exact_tests"] = static_cast<double>(found.report.exact_tests);
}

/// Pairs of triangles of two overlapping bodies that are closer than a hundredth of the bodies' size.
void closer_case(benchmark::State& state, int threads) {
  ProximityScene scene;
  scene.add(bodies().first);
  RigidTransform place;
  place.translation = {0.05, 0.02, 0.01};
  scene.update(scene.add(bodies().second), place);
  ProximityPairs found;
  const Context context = with_threads(threads);
  const Times times = time_runs([&] { found = scene.closer_than(0.01, context); });
  tell(state, times, 1);
  state.counters["pairs"] = static_cast<double>(found.pairs.size());
  state.counters["pairs_per_s"] = static_cast<double>(found.pairs.size()) / times.wall;
}

void penetration_case(benchmark::State& state) {
  ProximityScene scene;
  const ObjectId first = scene.add(bodies().first);
  const ObjectId second = scene.add(bodies().second);
  RigidTransform place;
  place.translation = {0.8, 0.02, 0.01};
  scene.update(second, place);
  Penetrations found;
  tell(state, time_runs([&] { found = scene.penetration(first, second, {}, with_threads(1)); }), 1);
  state.counters["parts"] = static_cast<double>(found.parts.size());
  state.counters["depth"] = found.parts.empty() ? 0 : found.parts.front().depth;
}

/// Counts the exact tests after culling by hierarchy or by Voronoi cells, and times the stages. Scenes: a body with
/// itself, two overlapping bodies, and a soup.
void culling_case(benchmark::State& state, const std::string& scene_name, std::optional<double> cell_size) {
  ProximityScene scene(cell_size ? SceneOptions{Culling::voronoi, *cell_size} : SceneOptions{Culling::bvh, 2});
  if (scene_name == "body") {
    scene.add(bodies().first, {.self = true});
  } else if (scene_name == "bodies") {
    scene.add(bodies().first);
    RigidTransform place;
    place.translation = {0.05, 0.02, 0.01};
    scene.update(scene.add(bodies().second), place);
  } else {
    scene.add(make_soup({.triangles = 20000, .triangle_size = 0.03}), {.self = true});
  }
  ProximityPairs found;
  const Context one = with_threads(1);
  tell(state, time_runs([&] { found = scene.closest_primitives(infinite, one); }), 1);
  const auto primitives = static_cast<double>(found.pairs.size());
  state.counters["cells"] = static_cast<double>(found.report.cells);
  state.counters["left_over"] = static_cast<double>(found.report.left_over);
  state.counters["candidates_per_primitive"] = static_cast<double>(found.report.candidates) / primitives;
  state.counters["exact_tests_per_primitive"] = static_cast<double>(found.report.exact_tests) / primitives;
  report_phases(state, found.report.phases);
}

const bool registered = [] {
  for (const std::string scene : {"body", "bodies", "soup"}) {
    add("culling/" + scene + "/bvh", [=](benchmark::State& state) { culling_case(state, scene, std::nullopt); });
    for (const double size : {0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0}) {
      add("culling/" + scene + "/voronoi-" + std::to_string(size).substr(0, 4),
          [=](benchmark::State& state) { culling_case(state, scene, size); });
    }
  }
  for (const double gap : {0.3, 0.1, 0.03, 0.01, 0.002}) {
    const std::string name = "separation-rigid/gap-" + std::to_string(gap).substr(0, 5) + "/";
    add(name + "blum", [=](benchmark::State& state) { rigid_case(state, gap, false); });
    add(name + "fcl", [=](benchmark::State& state) { rigid_case(state, gap, true); });
  }
  add("separation-deforming/blum", [](benchmark::State& state) { deforming_case<BlumDeforming>(state, 1); });
  add("separation-deforming/blum-2-threads", [](benchmark::State& state) { deforming_case<BlumDeforming>(state, 2); });
  if (fcl_bodies(bodies().first, bodies().second, FclBodies::aligned)) {
    add("separation-deforming/fcl-aligned-refit",
        [](benchmark::State& state) { deforming_case<FclDeforming>(state, FclBodies::aligned); });
    add("separation-deforming/fcl-oriented-rebuilt",
        [](benchmark::State& state) { deforming_case<FclDeforming>(state, FclBodies::oriented); });
  }
  add("self-collision/blum", [](benchmark::State& state) { self_case(state, 1); });
  add("self-collision/blum-2-threads", [](benchmark::State& state) { self_case(state, 2); });
  add("self-collision/blum-anew", self_anew_case);
  add("self-collision/cgal", cgal_self_case);
  for (const int height : {3, 5, 9}) {
    add("self-collision-as-cgal/crumpled-0.0" + std::to_string(height),
        [=](benchmark::State& state) { crossing_case(state, crumpled(0.01 * height)); });
  }
  add("self-collision-as-cgal/bodies", [](benchmark::State& state) { crossing_case(state, joined_bodies()); });
  add("self-collision-as-cgal/soup",
      [](benchmark::State& state) { crossing_case(state, make_soup({.triangles = 20000, .triangle_size = 0.03})); });
  add("n-body/blum", [](benchmark::State& state) { n_body_case(state, 1); });
  add("n-body/blum-2-threads", [](benchmark::State& state) { n_body_case(state, 2); });
  add("closer-than/blum", [](benchmark::State& state) { closer_case(state, 1); });
  add("closer-than/blum-2-threads", [](benchmark::State& state) { closer_case(state, 2); });
  add("penetration/blum", penetration_case);
  return true;
}();

}  // namespace
}  // namespace blum::bench
