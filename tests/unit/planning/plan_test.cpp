// Proves that found paths keep their clearance at many poses, and go around walls that samples would jump over.
// Searches without a solution end in time. Without OMPL, the search reports how to get it.
#include "blum/planning/plan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/shapes/generators.hpp"
#include "unit/planning/support.hpp"

namespace blum {
namespace {

using test::box;
using test::moved;
using test::slow_distance;
using test::turned_z;

/// Meshes of a problem.
struct Task {
  std::vector<TriangleMesh> bodies, obstacles;
  std::vector<RigidTransform> start, goal;

  [[nodiscard]] PlannedPath planned(const PlanOptions& options) const {
    return plan_path({.bodies = {bodies.begin(), bodies.end()},
                      .obstacles = {obstacles.begin(), obstacles.end()},
                      .start = start,
                      .goal = goal,
                      .bounds = {}},
                     options);
  }
  /// Compares a path with distances at many poses.
  void expect_proven(const PlannedPath& found, double clearance, int samples) const {
    ASSERT_TRUE(found.is_found);
    ASSERT_EQ(found.proof.verdict, MotionVerdict::free);
    EXPECT_GE(found.proof.at_least, clearance);
    ASSERT_GE(found.path.poses.size(), 2U);
    for (std::size_t k = 0; k + 1 < found.path.poses.size(); ++k) {
      std::vector<RigidMotion> motions;
      for (std::size_t body = 0; body < bodies.size(); ++body) {
        motions.emplace_back(found.path.poses[k][body], found.path.poses[k + 1][body], found.path.centres[body]);
      }
      for (int sample = 0; sample <= samples; ++sample) {
        EXPECT_GT(distance(motions, static_cast<double>(sample) / samples), clearance);
      }
    }
    for (std::size_t body = 0; body < bodies.size(); ++body) {
      EXPECT_LT(length(found.path.poses.front()[body].translation - start[body].translation), 1e-12);
      EXPECT_LT(length(found.path.poses.back()[body].translation - goal[body].translation), 1e-12);
    }
  }
  [[nodiscard]] double distance(const std::vector<RigidMotion>& motions, double time) const {
    double least = HUGE_VAL;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      for (const TriangleMesh& mesh : obstacles) {
        least = std::min(least, slow_distance(bodies[k], motions[k].at(time), mesh));
      }
      for (std::size_t other = 0; other < k; ++other) {
        least = std::min(least, slow_distance(bodies[k], motions[k].at(time), bodies[other], motions[other].at(time)));
      }
    }
    return least;
  }
};

/// A wall of a thousandth, with a window.
Task through_a_window() {
  Task out{.bodies = {box({0.3, 1.2, 0.3})},
           .obstacles = {box({1e-3, 4, 1.5}, {0, 0, 1.25}), box({1e-3, 4, 1.5}, {0, 0, -1.25}),
                         box({1e-3, 1.5, 1}, {0, 1.25, 0}), box({1e-3, 1.5, 1}, {0, -1.25, 0}),
                         box({6, 1e-3, 4}, {0, 2, 0}), box({6, 1e-3, 4}, {0, -2, 0}), box({6, 4, 1e-3}, {0, 0, 2}),
                         box({6, 4, 1e-3}, {0, 0, -2}), box({1e-3, 4, 4}, {3, 0, 0}), box({1e-3, 4, 4}, {-3, 0, 0})},
           .start = {moved({-1.5, 0, 0})},
           .goal = {moved({1.5, 0, 0})}};
  return out;
}

#define BLUM_NEEDS_OMPL()                                                           \
  if (!has_path_planner()) {                                                        \
    EXPECT_THROW(static_cast<void>(through_a_window().planned({})), InvalidOption); \
    return;                                                                         \
  }

TEST(Plan, TurnsABarThroughAWindow) {
  BLUM_NEEDS_OMPL();
  const Task task = through_a_window();
  const PlannedPath found = task.planned({.clearance = 0.02, .time = 20});
  task.expect_proven(found, 0.02, 60);
}

TEST(Plan, EndsInTimeIfThereIsNoPath) {
  BLUM_NEEDS_OMPL();
  Task task = through_a_window();
  task.obstacles.push_back(box({1e-3, 1.1, 1.1}));
  const PlannedPath found = task.planned({.time = 0.5});
  EXPECT_FALSE(found.is_found);
  EXPECT_TRUE(found.path.poses.empty());
  EXPECT_GT(found.states, 0U);
  EXPECT_LT(found.seconds, 5);
}

/// The inner part can only leave after the lid.
TEST(Plan, TakesPartsOutInAnOrderThatIsFound) {
  BLUM_NEEDS_OMPL();
  const Task task{
      .bodies = {box({0.5, 0.5, 0.5}), box({1.6, 1.6, 0.2}, {0, 0, 0})},
      .obstacles = {box({2, 2, 0.2}, {0, 0, -1}), box({0.2, 2, 1.6}, {1, 0, 0}), box({0.2, 2, 1.6}, {-1, 0, 0}),
                    box({2, 0.2, 1.6}, {0, 1, 0}), box({2, 0.2, 1.6}, {0, -1, 0})},
      .start = {moved({0, 0, -0.4}), moved({0, 0, 0.5})},
      .goal = {moved({3, 0, 2}), moved({-4, 0, 2})}};
  const PlannedPath found = task.planned({.time = 20});
  task.expect_proven(found, 0, 40);
  EXPECT_EQ(found.order, (std::vector<std::size_t>{1, 0}));
}

TEST(Plan, NamesWhatIsWrongWithStartAndGoal) {
  BLUM_NEEDS_OMPL();
  const auto error_of = [](const Task& task, const PlanOptions& options = {}) -> std::string {
    try {
      static_cast<void>(task.planned(options));
    } catch (const InvalidOption& error) {
      return error.what();
    }
    return "no error";
  };
  Task task{.bodies = {box({1, 1, 1})},
            .obstacles = {box({1, 1, 1}, {5, 0, 0})},
            .start = {moved({})},
            .goal = {moved({9, 0, 0})}};
  task.goal = {moved({4.5, 0, 0})};
  EXPECT_NE(error_of(task).find("at the goal, body 0 meets obstacle 0"), std::string::npos) << error_of(task);
  task.goal = {moved({9, 0, 0})};
  EXPECT_NE(error_of(task, {.clearance = 4}).find("at the start, body 0 is too close"), std::string::npos);
  EXPECT_NE(error_of(task, {.time = 0}).find("time must be positive"), std::string::npos);
  task.obstacles = {box({9, 9, 9})};
  task.goal = {moved({1, 0, 0})};
  EXPECT_NE(error_of(task).find("body 0 is inside the solid of obstacle 0"), std::string::npos);
  EXPECT_EQ(error_of(task, {.time = 1, .allow_inside = true}), "no error");
  task.goal.clear();
  EXPECT_NE(error_of(task).find("1 starts and 0 goals for 1 bodies"), std::string::npos);
}

}  // namespace
}  // namespace blum
