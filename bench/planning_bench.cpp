// Times certificates of motions that are free: a body of 56 triangles among boxes of 600, on one thread. Lengths are
// those of the space, a cube of side 1. All motions keep a clearance of 0.01.
#include <cstddef>
#include <vector>

#include "blum/core/random.hpp"
#include "blum/planning/certified_motion.hpp"
#include "blum/shapes/generators.hpp"
#include "support/measure.hpp"
#include "support/random_transform.hpp"

namespace blum::bench {
namespace {

constexpr double clearance = 0.01;
constexpr double delta = 1e-4;

TriangleMesh boxes_in_a_cube(Random& random) {
  TriangleMesh out;
  for (int k = 0; k < 50; ++k) {
    TriangleMesh box = make_box({.size = Vec3d{0.02, 0.02, 0.02} + random.in_cube() * 0.15});
    const Vec3d centre = random.in_cube();
    for (Vec3d& v : box.vertices) v += centre;
    append(out, box);
  }
  return out;
}

void edges(benchmark::State& state) {
  constexpr int tried = 20000;
  Random random(3);
  const TriangleMesh body =
      make_torus({.ring_radius = 0.05, .tube_radius = 0.015, .ring_segments = 7, .tube_segments = 4});
  const MotionCertifier certifier(body, boxes_in_a_cube(random));
  std::vector<RigidMotion> free;
  for (int k = 0; k < tried; ++k) {
    RigidTransform from = test::random_transform(random, 0);
    RigidTransform to = test::random_transform(random, 0);
    from.translation = random.in_cube();
    to.translation = from.translation + random.in_ball() * 0.3;
    const RigidMotion motion(from, to, certifier.centre());
    const CertifiedMotion found = certifier.certify(motion, {.clearance = clearance, .delta = delta});
    if (found.verdict == MotionVerdict::free) free.push_back(motion);
  }
  std::size_t tests = 0;
  const Times times = time_runs([&] {
    tests = 0;
    for (const RigidMotion& motion : free) tests += certifier.certify(motion, {.delta = delta}).tests;
  });
  const auto count = static_cast<double>(free.size());
  state.SetIterationTime(times.wall / count);
  state.counters["us_per_edge"] = 1e6 * times.cpu / count;
  state.counters["tests_per_edge"] = static_cast<double>(tests) / count;
  state.counters["edges"] = count;
}

const bool registered = [] {
  add("planning/certified_edge", edges);
  return true;
}();

}  // namespace
}  // namespace blum::bench
