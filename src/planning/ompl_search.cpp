#include "planning/path_search.hpp"

#ifdef BLUM_HAS_OMPL

#include <ompl/base/MotionValidator.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/kpiece/LBKPIECE1.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "blum/planning/certified_path.hpp"

namespace blum::detail {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

using Pose = ob::SE3StateSpace::StateType;

/// Converts states of OMPL, whose positions are those of the body's centre.
class Poses {
 public:
  explicit Poses(const Vec3d& centre) : centre_(centre) {}

  [[nodiscard]] RigidTransform pose(const ob::State* state) const {
    const auto& at = *state->as<Pose>();
    RigidTransform out = pose_of({0, 0, 0, at.rotation().w, at.rotation().x, at.rotation().y, at.rotation().z});
    out.translation = Vec3d{at.getX(), at.getY(), at.getZ()} - out.rotation * centre_;
    return out;
  }
  void set(ob::State* state, const RigidTransform& pose) const {
    const PoseNumbers numbers = numbers_of(pose);
    const Vec3d position = pose(centre_);
    auto& at = *state->as<Pose>();
    at.setXYZ(position.x, position.y, position.z);
    at.rotation().w = numbers[3];
    at.rotation().x = numbers[4];
    at.rotation().y = numbers[5];
    at.rotation().z = numbers[6];
  }

 private:
  Vec3d centre_;
};

class CertifiedMotions final : public ob::MotionValidator {
 public:
  CertifiedMotions(const ob::SpaceInformationPtr& information, const PathSearch& search, const Poses& poses)
      : ob::MotionValidator(information), search_(search), poses_(poses) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    return count(search_.free_until(poses_.pose(from), poses_.pose(to)) == 1);
  }
  bool checkMotion(const ob::State* from, const ob::State* to, std::pair<ob::State*, double>& last) const override {
    const double until = search_.free_until(poses_.pose(from), poses_.pose(to));
    if (until == 1) return count(true);
    last.second = until;
    if (last.first != nullptr) si_->getStateSpace()->interpolate(from, to, until, last.first);
    return count(false);
  }

 private:
  bool count(bool is_valid) const {
    ++(is_valid ? valid_ : invalid_);
    return is_valid;
  }
  const PathSearch& search_;
  const Poses& poses_;
};

/// Random states, some of them in narrow passages. A bridge is a pair of near states that are not free. If its middle
/// is free, it is such a state (Hsu, Jiang, Reif and Sun 2003).
class BridgeSampler final : public ob::StateSampler {
 public:
  BridgeSampler(const ob::StateSpace* space, const ob::SpaceInformation* information, double width)
      : ob::StateSampler(space),
        uniform_(space->allocDefaultStateSampler()),
        information_(information),
        width_(width) {}

  void sampleUniform(ob::State* state) override {
    constexpr double share = 0.2;
    constexpr int tries = 10;
    if (rng_.uniform01() < share) {
      for (int k = 0; k < tries; ++k) {
        if (sample_bridge(state)) return;
      }
    }
    uniform_->sampleUniform(state);
  }
  void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
    uniform_->sampleUniformNear(state, near, distance);
  }
  void sampleGaussian(ob::State* state, const ob::State* mean, double deviation) override {
    uniform_->sampleGaussian(state, mean, deviation);
  }

 private:
  bool sample_bridge(ob::State* state) {
    ob::ScopedState<> end(information_->getStateSpace());
    uniform_->sampleUniform(state);
    if (information_->isValid(state)) return false;
    uniform_->sampleGaussian(end.get(), state, width_);
    if (!space_->satisfiesBounds(end.get()) || information_->isValid(end.get())) return false;
    space_->interpolate(state, end.get(), 0.5, state);
    return information_->isValid(state);
  }

  ob::StateSamplerPtr uniform_;
  const ob::SpaceInformation* information_;
  double width_;
};

ob::PlannerPtr make_planner(const ob::SpaceInformationPtr& information, PathPlanner planner) {
  switch (planner) {
    case PathPlanner::rrt:
      return std::make_shared<og::RRT>(information);
    case PathPlanner::prm:
      return std::make_shared<og::PRM>(information);
    case PathPlanner::lbkpiece:
      return std::make_shared<og::LBKPIECE1>(information);
    case PathPlanner::rrt_star:
      return std::make_shared<og::RRTstar>(information);
    case PathPlanner::rrt_connect:
      break;
  }
  return std::make_shared<og::RRTConnect>(information);
}

std::shared_ptr<ob::SE3StateSpace> make_space(const PathSearch& search) {
  auto space = std::make_shared<ob::SE3StateSpace>();
  ob::RealVectorBounds bounds(3);
  for (unsigned axis = 0; axis < 3; ++axis) {
    bounds.setLow(axis, search.bounds.lower[axis]);
    bounds.setHigh(axis, search.bounds.upper[axis]);
  }
  space->setBounds(bounds);
  // OMPL measures a rotation by half its angle. With this weight, it counts as the displacement of the outermost point.
  space->setSubspaceWeight(1, 2 * search.size);
  return space;
}

}  // namespace

void set_search_seed(std::uint32_t seed) {
  ompl::msg::noOutputHandler();
  ompl::RNG::setSeed(seed);
}

FoundPath search_path(const PathSearch& search) {
  const Poses poses(search.centre);
  const auto space = make_space(search);
  og::SimpleSetup setup(space);
  const ob::SpaceInformationPtr& information = setup.getSpaceInformation();
  setup.setStateValidityChecker([&](const ob::State* state) {
    if (!space->satisfiesBounds(state)) return false;
    const RigidTransform pose = poses.pose(state);
    return search.free_until(pose, pose) == 1;
  });
  information->setMotionValidator(std::make_shared<CertifiedMotions>(information, search, poses));
  space->setStateSamplerAllocator(
      [&](const ob::StateSpace* of) { return std::make_shared<BridgeSampler>(of, information.get(), search.size); });
  ob::ScopedState<ob::SE3StateSpace> start(space), goal(space);
  poses.set(start.get(), search.start);
  poses.set(goal.get(), search.goal);
  setup.setStartAndGoalStates(start, goal);
  setup.setPlanner(make_planner(information, search.planner));
  const auto ends = ob::plannerOrTerminationCondition(ob::timedPlannerTerminationCondition(search.time),
                                                      ob::PlannerTerminationCondition(search.stops));
  const bool is_found = setup.solve(ends) == ob::PlannerStatus::EXACT_SOLUTION;
  FoundPath out;
  ob::PlannerData data(information);
  setup.getPlannerData(data);
  out.states = data.numVertices();
  if (!is_found || search.stops()) return out;
  og::PathGeometric& path = setup.getSolutionPath();
  og::PathSimplifier simplifier(information);
  for (int round = 0; round < 3; ++round) {
    simplifier.reduceVertices(path);
    simplifier.shortcutPath(path);
  }
  for (const ob::State* state : path.getStates()) out.poses.push_back(poses.pose(state));
  out.poses.front() = search.start;
  out.poses.back() = search.goal;
  return out;
}

}  // namespace blum::detail

#endif
