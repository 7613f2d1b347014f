// Times questions about two rigid bodies of 10,884 and 634 triangles at random poses: do they meet, and how far apart
// are they? Blum and peers answer in turn, on one thread, with poses of one kind per case. Another case compares one
// thread with two, for many poses in one call.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/proximity/scene.hpp"
#include "peers/collisions.hpp"
#include "support/measure.hpp"
#include "support/shapes.hpp"

namespace blum::bench {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr int poses_per_kind = 200;

Context with_threads(int threads) {
  Context context;
  context.threads = threads;
  return context;
}

/// Two bodies of about unit size. The first one rests.
const TriangleMesh& first_body() {
  return shape("ballcube").mesh;
}
const TriangleMesh& second_body() {
  return shape("eight").mesh;
}

/// Both bodies in a scene.
class Scene {
 public:
  Scene() : first_(scene_.add(first_body())), second_(scene_.add(second_body())) {}

  bool meets(const RigidTransform& place) {
    scene_.update(second_, place);
    return scene_.meets(first_, second_, one_);
  }
  double separation(const RigidTransform& place) {
    scene_.update(second_, place);
    return scene_.separation(first_, second_, infinite, one_)->between.distance;
  }
  [[nodiscard]] std::vector<std::uint8_t> meets(const std::vector<RigidTransform>& places, int threads) const {
    return scene_.meets(first_, second_, places, with_threads(threads));
  }

 private:
  ProximityScene scene_;
  ObjectId first_, second_;
  Context one_ = with_threads(1);
};

Vec3d direction(Random& random) {
  const Vec3d way = random.in_ball();
  return way / length(way);
}

Mat3 rotation(Random& random) {
  Mat3 out;
  auto& c = out.columns;
  c[0] = direction(random);
  c[1] = cross(c[0], direction(random));
  c[1] = c[1] / length(c[1]);
  c[2] = cross(c[0], c[1]);
  return out;
}

/// A random direction and rotation, and the place along this direction at which the distance is `gap`.
RigidTransform at_gap(Scene& scene, Random& random, double gap) {
  RigidTransform place{rotation(random), {}};
  const Vec3d way = direction(random);
  double low = 0;
  double high = 3;
  for (int step = 0; step < 18; ++step) {
    const double middle = (low + high) / 2;
    place.translation = way * middle;
    (scene.separation(place) > gap ? high : low) = middle;
  }
  place.translation = way * high;
  return place;
}

std::vector<RigidTransform> poses(const std::string& kind, int count) {
  Scene scene;
  Random random(7);
  std::vector<RigidTransform> out;
  for (int k = 0; k < count; ++k) {
    if (kind == "far") {
      out.push_back({rotation(random), direction(random) * random.uniform(2, 3)});
    } else if (kind == "random") {
      out.push_back({rotation(random), (random.in_cube() * 2.0) - Vec3d{1, 1, 1}});
    } else if (kind == "deep") {
      out.push_back({rotation(random), random.in_ball() * 0.15});
    } else if (kind == "shallow" || kind == "medium") {
      RigidTransform place = at_gap(scene, random, 1e-5);
      place.translation -= place.translation * ((kind == "shallow" ? 0.003 : 0.03) / length(place.translation));
      out.push_back(place);
    } else {
      out.push_back(at_gap(scene, random, std::stod(kind.substr(4))));
    }
  }
  return out;
}

/// A program that answers a question for one pose, with the seconds of each run over all poses.
struct Program {
  std::string name;
  std::function<double(const RigidTransform&)> answer;
  std::vector<Times> runs = {};
  double sum = 0;  ///< of the answers
};

/// Runs all programs in turn. Figures are CPU microseconds per pose, on one thread.
void compare(benchmark::State& state, const std::vector<RigidTransform>& places, std::vector<Program> programs) {
  constexpr int rounds = 15;
  for (int round = 0; round < rounds; ++round) {
    for (Program& program : programs) {
      program.runs.push_back(time_once([&] {
        program.sum = 0;
        for (const RigidTransform& place : places) program.sum += program.answer(place);
      }));
    }
  }
  const auto count = static_cast<double>(places.size());
  report(state, median(programs.front().runs), count);
  for (const Program& program : programs) {
    state.counters[program.name + "_us"] = median(program.runs).cpu * 1e6 / count;
    state.counters[program.name + "_mean_answer"] = program.sum / count;
    if (std::abs(program.sum - programs.front().sum) > 1e-9 * count) state.SkipWithError("programs disagree");
  }
}

/// @param is_distance  false: do the bodies meet? True: how far apart are they?
void question_case(benchmark::State& state, const std::string& kind, bool is_distance) {
  Scene scene;
  const auto fcl = fcl_bodies(first_body(), second_body(), FclBodies::oriented);
  const auto coal = coal_bodies(first_body(), second_body());
  const auto ask = [&](auto& bodies) {
    return [&, is_distance](const RigidTransform& place) {
      // Peers return negative distances for some bodies that meet.
      if (is_distance) return std::max(bodies.separation(place), 0.0);
      return bodies.meets(place) ? 1.0 : 0.0;
    };
  };
  std::vector<Program> programs{{"blum", ask(scene)}};
  if (fcl) programs.push_back({"fcl", ask(*fcl)});
  if (coal) programs.push_back({"coal", ask(*coal)});
  compare(state, poses(kind, poses_per_kind), std::move(programs));
}

/// 10,000 poses in one call.
void poses_case(benchmark::State& state) {
  const std::vector<RigidTransform> places = poses("random", 10000);
  const Scene scene;
  std::vector<std::uint8_t> by_one;
  std::vector<std::uint8_t> by_two;
  const TimesOfTwo times =
      time_in_turn([&] { by_one = scene.meets(places, 1); }, [&] { by_two = scene.meets(places, 2); });
  report(state, times.first, static_cast<double>(places.size()));
  state.counters["speedup"] = times.first.wall / times.second.wall;
  state.counters["us_of_one_thread"] = times.first.wall * 1e6 / static_cast<double>(places.size());
  if (by_one != by_two) state.SkipWithError("threads change the answer");
}

const bool registered = [] {
  for (const std::string kind : {"far", "random", "gap-0.1", "gap-0.01", "gap-0.001", "shallow", "medium", "deep"}) {
    add("rigid/meets/" + kind, [=](benchmark::State& state) { question_case(state, kind, false); });
    add("rigid/separation/" + kind, [=](benchmark::State& state) { question_case(state, kind, true); });
  }
  add("rigid/meets-10000-poses/two-threads", poses_case);
  return true;
}();

}  // namespace
}  // namespace blum::bench
