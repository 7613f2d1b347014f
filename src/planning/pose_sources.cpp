#include "planning/pose_sources.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "planning/check_pose.hpp"

namespace blum::detail {
namespace {

void check_count(std::size_t found, std::size_t bodies, const char* things) {
  if (found == bodies) return;
  throw InvalidOption("motion: there are " + std::to_string(found) + " " + things + " for " + std::to_string(bodies) +
                      (bodies == 1 ? " body" : " bodies") + "; give one for each body");
}

}  // namespace

RigidMotions::RigidMotions(const Bodies& data, std::span<const RigidMotion> motions) : motions_(motions) {
  check_count(motions.size(), data.bodies.size(), "motions");
  for (std::size_t k = 0; k < motions.size(); ++k) {
    const RigidMotion& motion = motions[k];
    double from_axis = 0, from_centre = 0;  // squared
    for (const Vec3d& p : data.bodies[k].hull_points()) {
      const Vec3d step = p - motion.centre();
      from_axis = std::max(from_axis, squared_length(cross(motion.axis(), step)));
      from_centre = std::max(from_centre, squared_length(step));
    }
    constexpr double rounding = 1 + 1e-14;
    const double reach = std::sqrt(from_centre);
    // A point on a circle of radius r that turns by an angle in the whole time accelerates by angle^2 r.
    bounds_.push_back({.speed = rounding * motion.speed(std::sqrt(from_axis)),
                       .acceleration = rounding * motion.angle() * motion.angle() * std::sqrt(from_axis),
                       .error = motion.rounding(reach),
                       .largest = reach + length(motion.at(0).translation) + length(motion.at(1).translation) +
                                  length(motion.centre())});
  }
}

void RigidMotions::set_poses(double time, std::span<RigidTransform> poses) const {
  for (std::size_t k = 0; k < motions_.size(); ++k) poses[k] = motions_[k].at(time);
}

std::optional<Twist> RigidMotions::twist(std::size_t body, double time) const {
  const RigidMotion& motion = motions_[body];
  return Twist{motion.velocity(), motion.angular_velocity(), motion.centre_at(time)};
}

GivenMotion::GivenMotion(const Bodies& data, const BoundedMotion& motion) : motion_(motion) {
  check_count(motion.speeds.size(), data.bodies.size(), "speeds");
  if (!motion.errors.empty()) check_count(motion.errors.size(), data.bodies.size(), "errors");
  if (!motion.poses_at) throw InvalidOption("motion: poses_at is empty; give a function that writes poses");
  for (const std::vector<double>* bounds : {&motion.speeds, &motion.errors}) {
    for (const double bound : *bounds) {
      if (bound >= 0 && std::isfinite(bound)) continue;
      throw InvalidOption("motion: bounds of speeds and errors must be 0 or more and finite, not " + exact_text(bound));
    }
  }
  std::vector<RigidTransform> start(data.bodies.size());
  set_poses(0, start);
  for (std::size_t k = 0; k < start.size(); ++k) {
    double squared = 0;
    for (const Vec3d& p : data.bodies[k].hull_points()) squared = std::max(squared, squared_length(p));
    reach_.push_back(std::sqrt(squared));
    // The origin of the body moves at most as far as a point of the body and the rotation about it.
    largest_.push_back(length(start[k].translation) + motion.speeds[k] + 3 * reach_[k]);
  }
}

void GivenMotion::set_poses(double time, std::span<RigidTransform> poses) const {
  motion_.poses_at(time, poses);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    check_pose(poses[k], "of body " + std::to_string(k) + " at time " + exact_text(time));
    poses[k].rotation = closest_rotation(poses[k].rotation);
  }
}

double GivenMotion::error(std::size_t body) const {
  constexpr double unit_of_rounding = 0x1p-53;
  const double given = motion_.errors.empty() ? 0 : motion_.errors[body];
  return given + unit_of_rounding * (240 * reach_[body] + 32 * largest_[body]);
}

}  // namespace blum::detail
