// Proves that answers about motions hold: free motions keep their clearance at thousands of times, by exhaustive
// distances. Places that are too close or collide are so at the reported time, and the motion is free before it.
#include "blum/planning/certified_motion.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/shapes/generators.hpp"
#include "support/random_transform.hpp"
#include "unit/planning/support.hpp"

namespace blum {
namespace {

constexpr double pi = std::numbers::pi;

using test::box;
using test::moved;
using test::slow_distance;
using test::turned_z;

/// Compares an answer with distances at many times.
void expect_true(const TriangleMesh& body, const TriangleMesh& obstacles, const RigidMotion& motion,
                 const MotionOptions& options, const CertifiedMotion& found, int samples) {
  for (int k = 0; k <= samples; ++k) {
    const double time = found.free_until * k / samples;
    if (time == found.free_until && found.verdict != MotionVerdict::free) break;
    EXPECT_GT(slow_distance(body, motion.at(time), obstacles), options.clearance) << "at " << time;
  }
  if (found.verdict == MotionVerdict::free) {
    EXPECT_EQ(found.free_until, 1);
    EXPECT_FALSE(found.closest);
    return;
  }
  EXPECT_LE(found.free_until, found.time);
  ASSERT_TRUE(found.closest);
  const double there = slow_distance(body, motion.at(found.time), obstacles);
  EXPECT_EQ(found.closest->distance, there);
  if (found.verdict == MotionVerdict::colliding) {
    EXPECT_EQ(there, 0);
  } else {
    EXPECT_LE(there, options.clearance + *options.delta);
  }
}

TEST(CertifiedMotion, OfABoxTowardsAWall) {
  const TriangleMesh body = box({1, 1, 1});
  const TriangleMesh wall = box({1, 10, 10}, {5, 0, 0});  // from x = 4.5
  const MotionOptions options{.clearance = 0.25, .delta = 1e-4};
  const auto certified = [&](double x) {
    return certify_motion(body, wall, RigidMotion(moved({}), moved({x, 0, 0}), {}), options);
  };
  EXPECT_EQ(certified(3.74).verdict, MotionVerdict::free);
  const CertifiedMotion close = certified(3.8);
  EXPECT_EQ(close.verdict, MotionVerdict::too_close);
  EXPECT_NEAR(3.8 * close.free_until, 3.75, 2e-4);
  EXPECT_LT(3.8 * close.free_until, 3.75);
  const CertifiedMotion through = certified(8);
  EXPECT_EQ(through.verdict, MotionVerdict::colliding);
  EXPECT_NEAR(8 * through.free_until, 3.75, 2e-4);
  EXPECT_LT(through.time, 0.8);
}

/// Discrete checks at steps of 1 % jump through a wall of 1/1000.
TEST(CertifiedMotion, FindsWallsThinnerThanSteps) {
  const TriangleMesh body = box({0.01, 0.01, 0.01});
  TriangleMesh wall;
  wall.vertices = {{0.505, -9, -9}, {0.505, 9, -9}, {0.505, 0, 9}};
  wall.triangles = {{0, 1, 2}};
  const CertifiedMotion found = certify_motion(body, wall, RigidMotion(moved({}), moved({1, 0, 0}), {}));
  EXPECT_EQ(found.verdict, MotionVerdict::colliding);
  EXPECT_NEAR(found.free_until, 0.5, 1e-5);
}

/// A rod that turns about its end sweeps an arc. Chords between its poses would miss the obstacle.
TEST(CertifiedMotion, OfARodThatTurns) {
  const TriangleMesh rod = box({4, 0.1, 0.1}, {2, 0, 0});
  const TriangleMesh pin = box({0.2, 0.2, 2}, {0, 3.9, 0});
  const auto certified = [&](double angle, double delta) {
    return certify_motion(rod, pin, RigidMotion(turned_z(0), turned_z(angle), {}), {.delta = delta});
  };
  EXPECT_EQ(certified(pi / 2 - 0.06, 1e-4).verdict, MotionVerdict::free);
  const CertifiedMotion found = certified(pi - 1e-3, 1e-6);
  EXPECT_EQ(found.verdict, MotionVerdict::colliding);
  // The upper edge of the rod reaches the pin's nearest corner (0.1, 3.8).
  const double contact = std::atan2(3.8, 0.1) - std::asin(0.05 / std::hypot(3.8, 0.1));
  EXPECT_NEAR(found.free_until * (pi - 1e-3), contact, 1e-5);
  EXPECT_LE(found.free_until * (pi - 1e-3), contact);
}

TEST(CertifiedMotion, AnswersAboutRandomMotionsHold) {
  Random random(5);
  const std::vector<TriangleMesh> shapes{box({1, 1, 1}),       box({2, 1e-3, 1}),
                                         box({1e-3, 1e-3, 3}), make_torus({.ring_segments = 12, .tube_segments = 6}),
                                         make_nested_shells(), make_soup({.triangles = 20})};
  std::array<int, 3> count{};
  for (const TriangleMesh& body : shapes) {
    for (const TriangleMesh& obstacles : shapes) {
      const MotionCertifier certifier(body, obstacles);
      for (int k = 0; k < 12; ++k) {
        const double far = random.uniform(1, 5);
        const RigidTransform from = test::random_transform(random, far), to = test::random_transform(random, far);
        const Vec3d centre = k % 3 == 0 ? random.in_ball() * 4.0 : certifier.centre();
        const RigidMotion motion(from, to, centre);
        const MotionOptions options{.clearance = k % 2 == 0 ? 0 : 0.05, .delta = 1e-3};
        const CertifiedMotion found = certifier.certify(motion, options);
        ++count[static_cast<std::size_t>(found.verdict)];
        if (body.triangles.size() * obstacles.triangles.size() <= 5000) {
          expect_true(body, obstacles, motion, options, found, 40);
        }
      }
    }
  }
  for (const int of_verdict : count) EXPECT_GT(of_verdict, 10);
}

TEST(CertifiedMotion, DoesNotDependOnThePlace) {
  const TriangleMesh near = box({1, 1, 1});
  const TriangleMesh wall = box({1, 10, 10}, {5, 0, 0});
  const Vec3d far{1e6, -2e6, 3e6};
  TriangleMesh far_wall = wall;
  for (Vec3d& v : far_wall.vertices) v += far;
  const MotionOptions options{.delta = 1e-5};
  const CertifiedMotion a = certify_motion(near, wall, RigidMotion(moved({}), moved({8, 0, 0}), {}), options);
  const CertifiedMotion b =
      certify_motion(near, far_wall, RigidMotion(moved(far), moved(far + Vec3d{8, 0, 0}), {}), options);
  EXPECT_EQ(a.verdict, b.verdict);
  EXPECT_NEAR(a.free_until, b.free_until, 1e-5);
}

TEST(CertifiedMotion, OfBodiesThatRest) {
  const TriangleMesh body = box({1, 1, 1});
  const RigidMotion still(moved({}), moved({}), {});
  EXPECT_EQ(certify_motion(body, box({1, 1, 1}, {3, 0, 0}), still).verdict, MotionVerdict::free);
  const CertifiedMotion touching = certify_motion(body, box({1, 1, 1}, {1, 0, 0}), still);
  EXPECT_EQ(touching.verdict, MotionVerdict::colliding);
  EXPECT_EQ(touching.free_until, 0);
  // Only surfaces count.
  EXPECT_EQ(certify_motion(box({0.1, 0.1, 0.1}), body, still).verdict, MotionVerdict::free);
}

TEST(CertifiedMotion, RejectsAbsurdOptions) {
  const TriangleMesh body = box({1, 1, 1});
  const RigidMotion still(moved({}), moved({}), {});
  for (const double wrong : {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(static_cast<void>(certify_motion(body, body, still, {.clearance = wrong})), InvalidOption);
    EXPECT_THROW(static_cast<void>(certify_motion(body, body, still, {.delta = wrong})), InvalidOption);
  }
  EXPECT_THROW(static_cast<void>(certify_motion(body, body, still, {.delta = 0})), InvalidOption);
  TriangleMesh far = body;
  far.vertices[0].x = 1e80;
  EXPECT_THROW(MotionCertifier(far, body), InvalidMesh);
  EXPECT_THROW(MotionCertifier(body, far), InvalidMesh);
  EXPECT_THROW(MotionCertifier(body, TriangleMesh{}), InvalidMesh);
}

}  // namespace
}  // namespace blum
