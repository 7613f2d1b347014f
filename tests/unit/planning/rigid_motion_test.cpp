// Proves that motions lead from one pose to the other at constant speeds, also for turns of nearly 0 and of 180
// degrees.
#include "blum/planning/rigid_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "support/random_transform.hpp"

namespace blum {
namespace {

constexpr double pi = std::numbers::pi;

RigidTransform turned(const Vec3d& axis, double angle, const Vec3d& translation = {}) {
  const Vec3d a = axis / length(axis);
  RigidTransform out;
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3d e;
    e[k] = 1;
    out.rotation.columns[k] =
        e * std::cos(angle) + cross(a, e) * std::sin(angle) + a * (dot(a, e) * (1 - std::cos(angle)));
  }
  out.translation = translation;
  return out;
}

double difference(const RigidTransform& a, const RigidTransform& b, double size) {
  double most = 0;
  for (const Vec3d& p : {Vec3d{}, Vec3d{size, 0, 0}, Vec3d{0, size, 0}, Vec3d{0, 0, size}}) {
    most = std::max(most, length(a(p) - b(p)));
  }
  return most;
}

TEST(RigidMotion, LeadsFromOnePoseToTheOther) {
  Random random(1);
  for (int k = 0; k < 500; ++k) {
    const RigidTransform from = test::random_transform(random, 10), to = test::random_transform(random, 10);
    const RigidMotion motion(from, to, random.in_ball());
    EXPECT_LE(difference(motion.at(0), from, 1), 2 * motion.rounding(1) + 1e-14);
    EXPECT_LE(difference(motion.at(1), to, 1), 2 * motion.rounding(1) + 1e-14);
    EXPECT_LE(motion.at(0.37).rotation_error(), 1e-14);
    EXPECT_LE(motion.angle(), pi);
  }
}

TEST(RigidMotion, TurnsByTheAngleBetweenThePoses) {
  Random random(2);
  for (const double angle : {0.0, 1e-9, 1e-3, 1.0, 3.0, pi - 1e-6, pi - 1e-12, pi}) {
    for (int k = 0; k < 50; ++k) {
      const RigidTransform from = test::random_transform(random, 1);
      const Vec3d axis = random.in_ball();
      const RigidMotion motion(from, from * turned(axis, angle), {});
      EXPECT_NEAR(motion.angle(), angle, 1e-14);
      EXPECT_LE(difference(motion.at(1), from * turned(axis, angle), 1), 1e-14);
      EXPECT_LE(difference(motion.at(0.25), from * turned(motion.axis(), angle / 4), 1), 1e-14);
    }
  }
}

TEST(RigidMotion, MovesTheCentreAlongALine) {
  Random random(3);
  for (int k = 0; k < 200; ++k) {
    const RigidTransform from = test::random_transform(random, 5), to = test::random_transform(random, 5);
    const Vec3d centre = random.in_ball() * 3.0;
    const RigidMotion motion(from, to, centre);
    const double time = random.uniform();
    EXPECT_LE(length(motion.at(time)(centre) - (from(centre) * (1 - time) + to(centre) * time)), 1e-13);
    EXPECT_NEAR(length(motion.velocity()), length(to(centre) - from(centre)), 1e-13);
  }
}

/// The way of a point between two times is at most the speed times the time.
TEST(RigidMotion, SpeedBoundsTheWayOfPoints) {
  Random random(4);
  for (int k = 0; k < 2000; ++k) {
    const RigidTransform from = test::random_transform(random, 2), to = test::random_transform(random, 2);
    const Vec3d centre = random.in_ball();
    const RigidMotion motion(from, to, centre);
    const Vec3d p = centre + random.in_ball();
    const double reach = length(cross(motion.axis(), p - centre));
    const double a = random.uniform();
    const double b = random.uniform();
    EXPECT_LE(length(motion.at(a)(p) - motion.at(b)(p)), std::abs(b - a) * motion.speed(reach) + 1e-14);
  }
}

TEST(RigidMotion, RejectsWhatIsNotAPose) {
  const RigidTransform still;
  RigidTransform scaled, mirrored, far, unknown;
  scaled.rotation.columns[0].x = 1 + 1e-6;
  mirrored.rotation.columns[0].x = -1;
  far.translation.x = 1e80;
  unknown.translation.y = std::numeric_limits<double>::quiet_NaN();
  for (const RigidTransform& wrong : {scaled, mirrored, far, unknown}) {
    EXPECT_THROW(RigidMotion(wrong, still, {}), InvalidOption);
    EXPECT_THROW(RigidMotion(still, wrong, {}), InvalidOption);
  }
  EXPECT_THROW(RigidMotion(still, still, {std::numeric_limits<double>::infinity(), 0, 0}), InvalidOption);
}

}  // namespace
}  // namespace blum
