// Proves that verify_path() certifies paths that keep their clearance. It refuses files with moved poses, raised
// clearances, missing intervals or other obstacles.
#include "blum/certificate/path_certificate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/random.hpp"
#include "blum/planning/certified_path.hpp"
#include "blum/shapes/generators.hpp"
#include "support/random_transform.hpp"
#include "unit/planning/support.hpp"

namespace blum {
namespace {

using test::box;

/// Meshes of a scene, and a path with the proof that the planning layer gives.
struct Scene {
  std::vector<TriangleMesh> bodies, obstacles;
  MotionPath path;

  [[nodiscard]] MotionCertifier certifier() const {
    const std::vector<MeshView> first(bodies.begin(), bodies.end()), second(obstacles.begin(), obstacles.end());
    return {first, second};
  }
  [[nodiscard]] StatedPath stated(const CertifiedPath& proof) const {
    StatedPath out{.centres = path.centres, .poses = {}, .clearance = proof.at_least, .intervals = {}};
    for (const auto& waypoint : path.poses) {
      out.poses.emplace_back();
      for (const RigidTransform& pose : waypoint) out.poses.back().push_back(numbers_of(pose));
    }
    for (const PathInterval& one : proof.intervals) {
      out.intervals.push_back({one.edge, one.from, one.to, one.clearance});
      out.clearance = std::min(out.clearance, one.clearance);
    }
    return out;
  }
  [[nodiscard]] PathCertificate verified(const StatedPath& path_) const {
    const std::vector<MeshView> first(bodies.begin(), bodies.end()), second(obstacles.begin(), obstacles.end());
    return verify_path(first, second, path_);
  }
};

Scene around_a_box() {
  Scene out{.bodies = {make_torus({.ring_segments = 8, .tube_segments = 5}), box({0.2, 0.1, 2})},
            .obstacles = {box({1, 1, 1}), box({0.5, 0.5, 8}, {0, 0, 6})},
            .path = {}};
  Random random(8);
  for (const Vec3d& way : {Vec3d{4, 0, 0}, Vec3d{3, 3, 1}, Vec3d{0, 4, 0}, Vec3d{-4, 1, 0}}) {
    std::vector<RigidTransform> poses;
    for (std::size_t k = 0; k < 2; ++k) {
      RigidTransform pose = test::random_transform(random, 0);
      pose.translation = way * (1.0 + static_cast<double>(k));
      poses.push_back(pose);
    }
    out.path.poses.push_back(poses);
  }
  out.path.centres = {{}, {0.1, 0, 0.5}};
  return out;
}

class PathCertificates : public testing::Test {
 protected:
  Scene scene = around_a_box();
  CertifiedPath proof = certify_path(scene.certifier(), scene.path);
  StatedPath stated = scene.stated(proof);

  void expect_refused(const std::string& reason) const {
    const PathCertificate found = scene.verified(stated);
    EXPECT_FALSE(found.holds);
    ASSERT_FALSE(found.mismatches.empty());
    EXPECT_NE(found.mismatches.front().find(reason), std::string::npos) << found.mismatches.front();
  }
};

TEST_F(PathCertificates, OfAProvenPathHolds) {
  ASSERT_EQ(proof.verdict, MotionVerdict::free);
  const PathCertificate found = scene.verified(stated);
  EXPECT_TRUE(found.holds) << (found.mismatches.empty() ? "" : found.mismatches.front());
  EXPECT_EQ(found.edges, 3U);
  EXPECT_LE(found.tests, 4 * stated.intervals.size());
  stated.intervals.clear();  // as of another program
  stated.clearance = 0.98 * proof.at_least;
  EXPECT_TRUE(scene.verified(stated).holds);
}

TEST_F(PathCertificates, RefusesRaisedClearances) {
  StatedPath as_proven = stated;
  stated.clearance = 1.1 * proof.at_most;
  expect_refused("that of the path is");
  for (auto& interval : stated.intervals) interval.clearance = std::max(interval.clearance, stated.clearance);
  expect_refused("the distance of body");
  stated = as_proven;
  stated.intervals.clear();
  stated.clearance = 1.01 * proof.at_most;
  expect_refused("the distance of body");
  stated.clearance = -1;
  expect_refused("must be 0 or more");
}

TEST_F(PathCertificates, RefusesMissingIntervals) {
  StatedPath as_proven = stated;
  stated.intervals.erase(stated.intervals.begin() + static_cast<std::ptrdiff_t>(stated.intervals.size() / 2));
  expect_refused("do not cover");
  stated = as_proven;
  stated.intervals.back().to = 0.999999;
  expect_refused("do not cover");
  stated = as_proven;
  stated.intervals.push_back({7, 0, 1, 10});
  expect_refused("belongs to motion 7");
  stated = as_proven;
  stated.poses.push_back(stated.poses.front());
  expect_refused("intervals of motion 3 do not cover");
}

TEST_F(PathCertificates, RefusesMovedPosesAndOtherMeshes) {
  StatedPath as_proven = stated;
  stated.poses[1][0] = {0, 0, 0.6, 1, 0, 0, 0};  // in the first obstacle
  expect_refused("the distance of body 0 and");
  stated = as_proven;
  stated.poses[2][1][3] = 2;
  expect_refused("a quaternion whose length is not 1");
  stated.poses[2][1][3] = NAN;
  expect_refused("not finite");
  stated = as_proven;
  stated.poses[0].pop_back();
  expect_refused("waypoint 0 has 1 poses for 2 bodies");
  stated = as_proven;
  scene.obstacles[0] = box({6, 6, 1});
  expect_refused("obstacle 0");
}

/// A turn by 180 degrees has two directions.
TEST_F(PathCertificates, RefusesHalfTurns) {
  stated.intervals.clear();
  stated.clearance = 0;
  stated.poses[0][0] = {0, 20, 0, 1, 0, 0, 0};
  stated.poses[1][0] = {0, 20, 0, 0, 0, 0, 1};
  expect_refused("180 degrees");
}

/// A needle passes a wall of one triangle between any two samples.
TEST(PathCertificate, SeesThinWalls) {
  TriangleMesh wall;
  wall.vertices = {{0.5037, -9, -9}, {0.5037, 9, -9}, {0.5037, 0, 9}};
  wall.triangles = {{0, 1, 2}};
  const Scene scene{.bodies = {box({1e-4, 1e-4, 1e-4})}, .obstacles = {wall}, .path = {}};
  StatedPath through{.centres = {{}}, .poses = {{{0, 0, 0, 1, 0, 0, 0}}, {{1, 0, 0, 1, 0, 0, 0}}}, .intervals = {}};
  EXPECT_FALSE(scene.verified(through).holds);
  through.poses[1][0][0] = 0.5036;
  EXPECT_TRUE(scene.verified(through).holds);
}

TEST(PathCertificate, OfRandomPathsAgreesWithThePlanningLayer) {
  Random random(31);
  const std::vector<TriangleMesh> shapes{box({1, 1, 1}), box({2, 1e-3, 1}),
                                         make_torus({.ring_segments = 6, .tube_segments = 4}),
                                         make_soup({.triangles = 12})};
  int free = 0, refused = 0;
  for (int k = 0; k < 40; ++k) {
    const TriangleMesh& body = shapes[random.below(shapes.size())];
    const TriangleMesh& obstacle = shapes[random.below(shapes.size())];
    Scene scene{.bodies = {body}, .obstacles = {obstacle}, .path = {}};
    scene.path.centres = {random.in_ball()};
    const double far = random.uniform(2, 6);
    for (int waypoint = 0; waypoint < 3; ++waypoint) {
      const RigidTransform pose = test::random_transform(random, far);
      scene.path.poses.push_back({pose});
    }
    const CertifiedPath proof = certify_path(scene.certifier(), scene.path);
    StatedPath stated = scene.stated(proof);
    if (proof.verdict == MotionVerdict::free) {
      ++free;
      const PathCertificate found = scene.verified(stated);
      EXPECT_TRUE(found.holds) << (found.mismatches.empty() ? "" : found.mismatches.front());
      stated.intervals.clear();
      stated.clearance = 1.001 * proof.at_most + 1e-9;
    } else {
      stated.clearance = 0;
    }
    ++refused;
    EXPECT_FALSE(scene.verified(stated).holds);
  }
  EXPECT_GT(free, 5);
  EXPECT_GT(refused, 5);
}

TEST(PathCertificate, RejectsBadInput) {
  EXPECT_THROW(static_cast<void>(verify_path({}, {}, {})), InvalidOption);
  const Scene alone{.bodies = {box({1, 1, 1})}, .obstacles = {}, .path = {}};
  EXPECT_THROW(static_cast<void>(alone.verified({})), InvalidOption);
  const Scene scene{.bodies = {TriangleMesh{}}, .obstacles = {box({1, 1, 1})}, .path = {}};
  EXPECT_THROW(static_cast<void>(scene.verified({})), InvalidMesh);
}

}  // namespace
}  // namespace blum
