// Times continuous collisions of two beams, one of which falls through the other: all pairs, and the first contact
// alone. Faces are aligned and parallel. Beams that are moved aside, scaled or turned show the cost of such positions.
// Cases use one thread.
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "blum/proximity/scene.hpp"
#include "blum/shapes/generators.hpp"
#include "support/measure.hpp"

namespace blum::bench {
namespace {

/// Two beams of 2,304 triangles each. The upper one falls straight through the lower one.
struct Beams {
  TriangleMesh lower = make_box({.size = {10, 1, 1}, .segments = {32, 8, 8}});
  TriangleMesh upper = lower;
  std::vector<Vec3d> end;

  explicit Beams(const std::string& place) {
    for (Vec3d& p : upper.vertices) p += Vec3d{0, 0, 3};
    end = upper.vertices;
    for (Vec3d& p : end) p += Vec3d{0, 0, -6};
    if (place == "moved") {
      move(upper.vertices, [](const Vec3d& p) { return p + Vec3d{0.0131, 0.0122, 0}; });
      move(end, [](const Vec3d& p) { return p + Vec3d{0.0131, 0.0122, 0}; });
    } else if (place == "scaled") {
      move_all([](const Vec3d& p) { return p * 0.1; });
    } else if (place == "turned") {
      move_all([](const Vec3d& p) {
        return Vec3d{p.x * std::cos(0.3) - p.y * std::sin(0.3), p.x * std::sin(0.3) + p.y * std::cos(0.3), p.z};
      });
    }
  }

 private:
  template <class Move>
  static void move(std::vector<Vec3d>& vertices, const Move& change) {
    for (Vec3d& p : vertices) p = change(p);
  }
  template <class Move>
  void move_all(const Move& change) {
    for (auto* vertices : {&lower.vertices, &upper.vertices, &end}) move(*vertices, change);
  }
};

void report_times(benchmark::State& state, const Times& times) {
  state.SetIterationTime(times.wall);
  state.counters["cpu_s"] = times.cpu;
  state.counters["runs"] = times.runs;
  state.counters["load"] = times.load;
}

void beams_case(benchmark::State& state, const std::string& place, bool is_first_only) {
  const Beams beams(place);
  ProximityScene scene;
  scene.add(beams.lower);
  const std::vector<ObjectMotion> motions{{scene.add(beams.upper), beams.end, {}}};
  const Context context{.threads = 1};
  std::optional<double> earliest;
  if (is_first_only) {
    report_times(state, time_runs([&] { earliest = scene.first_contact(motions, {}, context)->time(); }));
  } else {
    SceneCollisions found;
    const Times times = time_runs([&] { found = scene.continuous(motions, {}, context); });
    report_times(state, times);
    earliest = found.earliest();
    state.counters["exact_tests"] = static_cast<double>(found.exact_tests);
    state.counters["us_per_test"] = times.cpu * 1e6 / static_cast<double>(found.exact_tests);
  }
  if (!earliest || std::abs(*earliest - 1.0 / 3) > 1e-5) state.SkipWithError("wrong time of the first contact");
}

const bool registered = [] {
  for (const std::string place : {"aligned", "moved", "scaled", "turned"}) {
    add("continuous-beams/" + place, [=](benchmark::State& state) { beams_case(state, place, false); });
    add("first-contact-beams/" + place, [=](benchmark::State& state) { beams_case(state, place, true); });
  }
  return true;
}();

}  // namespace
}  // namespace blum::bench
