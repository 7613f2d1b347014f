// Proves answers about several moving bodies, first contacts, clearances and paths. The tests compare them with
// exhaustive distances at many times, and with contacts that are known exactly.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/planning/certified_motion.hpp"
#include "blum/planning/certified_path.hpp"
#include "blum/shapes/generators.hpp"
#include "support/random_transform.hpp"
#include "unit/planning/support.hpp"

namespace blum {
namespace {

using test::box;
using test::moved;
using test::slow_distance;
using test::turned_z;

constexpr double pi = std::numbers::pi;

/// Bodies and obstacles with random motions.
struct Scene {
  std::vector<TriangleMesh> bodies, obstacles;

  [[nodiscard]] MotionCertifier certifier() const {
    const std::vector<MeshView> first(bodies.begin(), bodies.end()), second(obstacles.begin(), obstacles.end());
    return {first, second};
  }
  /// Returns the smallest distance of all pairs at a time.
  [[nodiscard]] double distance(std::span<const RigidMotion> motions, double time) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      const RigidTransform pose = motions[k].at(time);
      for (const TriangleMesh& mesh : obstacles) least = std::min(least, slow_distance(bodies[k], pose, mesh));
      for (std::size_t other = 0; other < k; ++other) {
        least = std::min(least, slow_distance(bodies[k], pose, bodies[other], motions[other].at(time)));
      }
    }
    return least;
  }
};

Scene three_bodies() {
  return {.bodies = {box({1, 1, 1}), box({2, 1e-3, 1}), make_torus({.ring_segments = 6, .tube_segments = 4})},
          .obstacles = {box({1, 2, 1}, {0, 0, 4}), box({1e-3, 3, 3}, {-3, 0, 0})}};
}

std::vector<RigidMotion> random_motions(Random& random, const MotionCertifier& certifier, double far) {
  std::vector<RigidMotion> out;
  for (std::size_t k = 0; k < certifier.size(); ++k) {
    const RigidTransform from = test::random_transform(random, far);
    const RigidTransform to = test::random_transform(random, far);
    out.emplace_back(from, to, certifier.centre(k));
  }
  return out;
}

TEST(SeveralBodies, AnswersHold) {
  Random random(11);
  const Scene scene = three_bodies();
  const MotionCertifier certifier = scene.certifier();
  std::array<int, 3> count{};
  for (int k = 0; k < 60; ++k) {
    const double far = random.uniform(2, 12);
    const std::vector<RigidMotion> motions = random_motions(random, certifier, far);
    const MotionOptions options{.clearance = k % 2 == 0 ? 0 : 0.4, .delta = 1e-3};
    const CertifiedMotion found = certifier.certify(motions, options);
    ++count[static_cast<std::size_t>(found.verdict)];
    for (int sample = 0; sample < 8 && found.free_until > 0; ++sample) {
      EXPECT_GT(scene.distance(motions, found.free_until * (sample + 0.5) / 8), options.clearance);
    }
    if (found.verdict == MotionVerdict::free) continue;
    ASSERT_TRUE(found.closest);
    EXPECT_NEAR(found.closest->distance, scene.distance(motions, found.time), 1e-12);
    EXPECT_NE(found.closest->other_body.has_value(), found.closest->obstacle.has_value());
    if (found.verdict == MotionVerdict::too_close) {
      EXPECT_LE(found.closest->distance, options.clearance + 1e-3);
    } else {
      EXPECT_EQ(found.closest->distance, 0);
    }
  }
  for (const int of_verdict : count) EXPECT_GT(of_verdict, 3);
}

/// A motion of two bodies gives the same answer as the motion of one of them if the other rests.
TEST(SeveralBodies, OneRestsAsAnObstacle) {
  Random random(3);
  const TriangleMesh a = box({1, 1, 1}), b = make_torus({.ring_segments = 6, .tube_segments = 4});
  const Scene both{.bodies = {a, b}, .obstacles = {}};
  const MotionCertifier of_two = both.certifier();
  const MotionCertifier of_one(a, b);
  for (int k = 0; k < 60; ++k) {
    std::vector<RigidMotion> motions = random_motions(random, of_two, 3);
    motions[1] = RigidMotion({}, {}, {});
    const CertifiedMotion two = of_two.certify(motions), one = of_one.certify(motions[0]);
    EXPECT_EQ(two.verdict, one.verdict);
    EXPECT_NEAR(two.free_until, one.free_until, 1e-5);
    if (two.closest) {
      EXPECT_EQ(two.closest->other_body, 1U);
    }
  }
}

TEST(SeveralBodies, ExcludedPairsAreNotCompared) {
  const Scene scene{.bodies = {box({1, 1, 1}), box({1, 1, 1}, {0.5, 0, 0})}, .obstacles = {box({9, 9, 1}, {0, 0, -1})}};
  MotionCertifier certifier = scene.certifier();
  const std::vector<RigidMotion> rest(2, RigidMotion({}, {}, {}));
  EXPECT_EQ(certifier.certify(rest).verdict, MotionVerdict::colliding);
  certifier.exclude(1, 0);
  EXPECT_EQ(certifier.certify(rest).closest->obstacle, 0U);  // both touch the obstacle
  certifier.exclude_obstacles(0);
  EXPECT_EQ(certifier.certify(rest).closest->body, 1U);
  certifier.exclude_obstacles(1);
  EXPECT_EQ(certifier.certify(rest).verdict, MotionVerdict::free);
  EXPECT_THROW(certifier.exclude(0, 0), InvalidOption);
  EXPECT_THROW(certifier.exclude(0, 2), InvalidOption);
  EXPECT_THROW(certifier.exclude_obstacles(2), InvalidOption);
}

/// Primitives of several obstacles are numbered within each obstacle: triangles, then segments, then points.
TEST(SeveralBodies, ObstaclesKeepTheirNumbers) {
  TriangleMesh mixed;
  mixed.vertices = {{10, 0, 0}, {11, 0, 0}, {10, 1, 0}, {20, 0, 0}, {21, 0, 0}, {30, 0, 0}, {40, 0, 0}};
  mixed.triangles = {{0, 1, 2}};
  mixed.segments = {{3, 4}};
  mixed.points = {5, 6};
  TriangleMesh second = mixed;
  for (Vec3d& v : second.vertices) v.y += 100;
  second.vertices.insert(second.vertices.end(), {{50, 100, 0}, {51, 100, 0}, {50, 101, 0}});
  second.triangles.push_back({7, 8, 9});
  const Scene scene{.bodies = {box({1e-2, 1e-2, 1e-2})}, .obstacles = {mixed, second, mixed}};
  const MotionCertifier certifier = scene.certifier();
  const auto near = [&](const Vec3d& place) {
    const std::vector motion{RigidMotion(moved(place), moved(place), {})};
    return *certifier.clearance(motion).closest;
  };
  const auto expect = [&](const Vec3d& place, std::uint32_t obstacle, std::uint32_t primitive) {
    const MotionPair pair = near(place);
    EXPECT_EQ(pair.obstacle, obstacle);
    EXPECT_EQ(pair.other_primitive, primitive);
  };
  expect({10.2, 100.2, 1}, 1, 0);
  expect({50.2, 100.2, 1}, 1, 1);
  expect({20.5, 100, 1}, 1, 2);
  expect({30, 100, 1}, 1, 3);
  expect({40, 100, 1}, 1, 4);
  EXPECT_EQ(near({20.5, 0, 1}).other_primitive, 1U);
  EXPECT_EQ(near({40, 0, 1}).other_primitive, 3U);
}

/// A chain of two links, whose second link turns faster than its bound of one link allows: poses come from a function.
TEST(SeveralBodies, OfLinksWithGivenBounds) {
  const Scene scene{.bodies = {box({2, 0.1, 0.1}, {1, 0, 0}), box({2, 0.1, 0.1}, {1, 0, 0})},
                    .obstacles = {box({0.2, 0.2, 4}, {1, 3, 0})}};
  MotionCertifier certifier = scene.certifier();
  certifier.exclude(0, 1);
  const double turn = pi / 2;
  BoundedMotion motion;
  motion.poses_at = [&](double time, std::span<RigidTransform> poses) {
    poses[0] = turned_z(turn * time);
    poses[1] = poses[0] * turned_z(turn * time, {2, 0, 0});
  };
  motion.speeds = {turn * 2.01, turn * 2 + 2 * turn * 2.01};
  const CertifiedMotion found = certifier.certify(motion, {.delta = 1e-4});
  ASSERT_EQ(found.verdict, MotionVerdict::colliding);
  std::vector<RigidTransform> poses(2);
  const auto distance = [&](double time) {
    motion.poses_at(time, poses);
    return std::min(slow_distance(scene.bodies[0], poses[0], scene.obstacles[0]),
                    slow_distance(scene.bodies[1], poses[1], scene.obstacles[0]));
  };
  for (int k = 0; k < 500; ++k) EXPECT_GT(distance(found.free_until * (k + 0.5) / 500), 0);
  EXPECT_LT(distance(found.free_until), 2e-4);
  EXPECT_EQ(distance(found.time), 0);
  motion.speeds = {1};
  EXPECT_THROW(static_cast<void>(certifier.certify(motion)), InvalidOption);
  motion.speeds = {1, -1};
  EXPECT_THROW(static_cast<void>(certifier.certify(motion)), InvalidOption);
  motion.speeds = {1, 1};
  motion.poses_at = [](double, std::span<RigidTransform> given) { given[1].rotation.columns[0] = {2, 0, 0}; };
  EXPECT_THROW(static_cast<void>(certifier.certify(motion)), InvalidOption);
}

TEST(FirstContact, OfTranslationsIsKnown) {
  const MotionCertifier certifier(box({1, 1, 1}), box({1, 10, 10}, {5, 0, 0}));
  for (const double way : {4.25, 5.0, 8.0, 1000.0}) {
    const std::vector motion{RigidMotion(moved({}), moved({way, 0.3, 0.1}), {})};
    const auto found = certifier.first_contact(motion);
    ASSERT_TRUE(found) << way;
    ASSERT_TRUE(found->latest);
    EXPECT_LE(found->earliest, 4 / way);
    EXPECT_NEAR(found->earliest, 4 / way, 1e-12);
    EXPECT_NEAR(*found->latest, 4 / way, 1e-9);
    EXPECT_EQ(found->pair.distance, 0);
  }
  const std::vector motion{RigidMotion(moved({}), moved({3.999999, 0, 0}), {})};
  EXPECT_FALSE(certifier.first_contact(motion));
}

TEST(FirstContact, OfARodThatTurnsIsKnown) {
  const MotionCertifier certifier(box({4, 0.1, 0.1}, {2, 0, 0}), box({0.2, 0.2, 2}, {0, 3.9, 0}));
  const double angle = pi - 1e-3;
  const std::vector motion{RigidMotion(turned_z(0), turned_z(angle), {})};
  const auto found = certifier.first_contact(motion, 1e-12);
  ASSERT_TRUE(found && found->latest);
  // The upper edge of the rod reaches the pin's nearest corner (0.1, 3.8).
  const double contact = (std::atan2(3.8, 0.1) - std::asin(0.05 / std::hypot(3.8, 0.1))) / angle;
  EXPECT_LE(found->earliest, contact + 1e-15);
  EXPECT_NEAR(found->earliest, contact, 1e-12);
  EXPECT_NEAR(*found->latest, contact, 1e-11);
}

/// Motions graze: surfaces come within 1e-9, and do not meet.
TEST(FirstContact, DoesNotTakeAnApproachForAContact) {
  const MotionCertifier certifier(box({1, 1, 1}), box({1, 1, 1}, {3, 1 + 1e-9, 0}));
  const std::vector past{RigidMotion(moved({}), moved({6, 0, 0}), {})};
  EXPECT_FALSE(certifier.first_contact(past));
  const MotionCertifier touching(box({1, 1, 1}), box({1, 1, 1}, {3, 1, 0}));
  const auto found = touching.first_contact(past);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->earliest, 1.0 / 3, 1e-9);
}

TEST(FirstContact, OfRandomMotionsIsNeverLate) {
  Random random(21);
  const Scene scene = three_bodies();
  const MotionCertifier certifier = scene.certifier();
  int met = 0;
  for (int k = 0; k < 20; ++k) {
    const std::vector<RigidMotion> motions = random_motions(random, certifier, 6);
    const auto found = certifier.first_contact(motions);
    const double until = found ? found->earliest : 1;
    for (int sample = 0; sample < 20 && until > 0; ++sample) {
      EXPECT_GT(scene.distance(motions, until * (sample + 0.5) / 20), 0);
    }
    if (!found) continue;
    ++met;
    ASSERT_TRUE(found->latest);
    EXPECT_EQ(scene.distance(motions, *found->latest), 0);
    EXPECT_LE(scene.distance(motions, found->earliest), 1e-10);
  }
  EXPECT_GT(met, 4);
}

TEST(MotionClearance, BoundsHold) {
  Random random(7);
  const Scene scene = three_bodies();
  const MotionCertifier certifier = scene.certifier();
  int apart = 0;
  for (int k = 0; k < 20; ++k) {
    const std::vector<RigidMotion> motions = random_motions(random, certifier, 9);
    const MotionClearance found = certifier.clearance(motions, 0.01);
    ASSERT_TRUE(found.closest);
    EXPECT_NEAR(scene.distance(motions, found.time), found.at_most, 1e-12);
    EXPECT_LE(found.at_least, found.at_most);
    EXPECT_GE(found.at_least, 0.99 * found.at_most - 1e-10);
    apart += found.at_least > 0 ? 1 : 0;
    for (int sample = 0; sample < 25; ++sample) {
      EXPECT_GE(scene.distance(motions, (sample + 0.5) / 25), found.at_least);
    }
  }
  EXPECT_GT(apart, 3);
}

/// A long body slides along a wall at a small gap. Bounds use velocities across the gap, so they need few tests.
TEST(MotionClearance, OfASlidingBodyNeedsFewTests) {
  const double gap = 1e-5;
  const MotionCertifier certifier(box({2, 1, 1}), box({20, 1, 1}, {0, 1 + gap, 0}));
  const std::vector slide{RigidMotion(moved({-5, 0, 0}), moved({5, 0, 0}), {})};
  const MotionClearance found = certifier.clearance(slide);
  EXPECT_LE(found.at_least, gap);
  EXPECT_GE(found.at_least, 0.95 * gap);
  EXPECT_LT(found.tests, 400U);
  const CertifiedMotion kept = certifier.certify(slide, {.clearance = 0.9 * gap, .delta = 1e-7});
  EXPECT_EQ(kept.verdict, MotionVerdict::free);
  EXPECT_LT(kept.tests, 400U);
}

MotionPath path_around(const Scene& scene) {
  MotionPath path;
  const std::vector<Vec3d> ways{{5, 0, 0}, {4, 4, 1}, {0, 5, 0}, {-5, 3, 2}};
  Random random(2);
  for (const Vec3d& way : ways) {
    std::vector<RigidTransform> poses;
    for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
      RigidTransform pose = test::random_transform(random, 0);
      pose.translation = way + Vec3d{0, 0, 4.0 * static_cast<double>(k)};
      poses.push_back(pose);
    }
    path.poses.push_back(poses);
  }
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) path.centres.push_back({});
  return path;
}

TEST(CertifiedPath, IntervalsCoverTheMotionsAndHold) {
  Scene scene = three_bodies();
  scene.obstacles = {box({1, 1, 1})};
  const MotionCertifier certifier = scene.certifier();
  const MotionPath path = path_around(scene);
  const CertifiedPath found = certify_path(certifier, path, {.clearance = 0.1, .tolerance = 0.02});
  ASSERT_EQ(found.verdict, MotionVerdict::free);
  EXPECT_GE(found.at_least, 0.98 * found.at_most);
  double end = 1, least = found.at_most;
  std::uint32_t edge = 0xffffffff;
  for (const PathInterval& interval : found.intervals) {
    if (end == 1 && interval.from == 0) {
      ++edge;
    } else {
      EXPECT_EQ(interval.from, end);
    }
    EXPECT_EQ(interval.edge, edge);
    end = interval.to;
    least = std::min(least, interval.clearance);
    std::vector<RigidMotion> motions;
    for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
      motions.emplace_back(path.poses[edge][k], path.poses[edge + 1][k], path.centres[k]);
    }
    for (const double part : {0.0, 0.3, 0.9}) {
      EXPECT_GE(scene.distance(motions, interval.from + part * (interval.to - interval.from)), interval.clearance);
    }
  }
  EXPECT_EQ(end, 1);
  EXPECT_EQ(edge, 2U);
  EXPECT_EQ(least, found.at_least);
}

TEST(CertifiedPath, NamesTheFirstMotionThatIsNotFree) {
  const Scene scene{.bodies = {box({1, 1, 1})}, .obstacles = {box({1, 1, 1}, {5, 0, 0})}};
  const MotionCertifier certifier = scene.certifier();
  MotionPath path{.centres = {{}},
                  .poses = {{moved({})}, {moved({0, 3, 0})}, {moved({10, -3, 0})}, {moved({5, 0, 0})}}};
  const CertifiedPath found = certify_path(certifier, path);
  EXPECT_EQ(found.verdict, MotionVerdict::colliding);
  EXPECT_EQ(found.edge, 1U);
  EXPECT_TRUE(found.intervals.empty());
  EXPECT_EQ(found.closest->obstacle, 0U);
  path.poses.resize(1);
  const CertifiedPath still = certify_path(certifier, path);
  EXPECT_EQ(still.verdict, MotionVerdict::free);
  EXPECT_EQ(still.intervals.size(), 1U);
  EXPECT_NEAR(still.at_least, 4, 0.2);
  path.poses[0].clear();
  EXPECT_THROW(static_cast<void>(certify_path(certifier, path)), InvalidOption);
  path.poses.clear();
  EXPECT_THROW(static_cast<void>(certify_path(certifier, path)), InvalidOption);
}

TEST(PoseNumbers, KeepThePose) {
  Random random(4);
  for (int k = 0; k < 200; ++k) {
    RigidTransform pose = test::random_transform(random, 5);
    if (k == 0) pose = moved({1, 2, 3});
    if (k == 1) pose = turned_z(pi);
    const RigidTransform again = pose_of(numbers_of(pose));
    EXPECT_EQ(again.translation, pose.translation);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_LT(length(again.rotation.columns[c] - pose.rotation.columns[c]), 2e-15);
    }
  }
  EXPECT_THROW(static_cast<void>(pose_of({0, 0, 0, 1, 1, 0, 0})), InvalidOption);
  EXPECT_THROW(static_cast<void>(pose_of({0, 0, 0, 0, 0, 0, 0})), InvalidOption);
  EXPECT_THROW(static_cast<void>(pose_of({0, NAN, 0, 1, 0, 0, 0})), InvalidOption);
}

}  // namespace
}  // namespace blum
