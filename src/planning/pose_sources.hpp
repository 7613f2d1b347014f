// Blum: poses over time of rigid motions and of the caller's functions. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "blum/planning/rigid_motion.hpp"
#include "planning/motion_tests.hpp"

namespace blum::detail {

/// Rigid motions, one for each body.
class RigidMotions final : public PosesOverTime {
 public:
  /// @throws InvalidOption if the number of motions is not that of the bodies.
  RigidMotions(const Bodies& data, std::span<const RigidMotion> motions);

  void set_poses(double time, std::span<RigidTransform> poses) const override;
  [[nodiscard]] double speed(std::size_t body) const override { return bounds_[body].speed; }
  [[nodiscard]] std::optional<Twist> twist(std::size_t body, double time) const override;
  [[nodiscard]] double acceleration(std::size_t body) const override { return bounds_[body].acceleration; }
  [[nodiscard]] double error(std::size_t body) const override { return bounds_[body].error; }
  [[nodiscard]] double largest(std::size_t body) const override { return bounds_[body].largest; }

 private:
  struct Bounds {
    double speed = 0, acceleration = 0, error = 0, largest = 0;
  };
  std::span<const RigidMotion> motions_;
  std::vector<Bounds> bounds_;
};

/// Motions that the caller computes.
class GivenMotion final : public PosesOverTime {
 public:
  /// @throws InvalidOption if a bound is missing, negative or not finite, or if the pose of a body at the start is
  /// invalid.
  GivenMotion(const Bodies& data, const BoundedMotion& motion);

  /// @throws InvalidOption for an invalid pose.
  void set_poses(double time, std::span<RigidTransform> poses) const override;
  [[nodiscard]] double speed(std::size_t body) const override { return motion_.speeds[body]; }
  /// The caller gives no velocities.
  [[nodiscard]] std::optional<Twist> twist(std::size_t /*body*/, double /*time*/) const override { return {}; }
  [[nodiscard]] double acceleration(std::size_t /*body*/) const override { return 0; }
  [[nodiscard]] double error(std::size_t body) const override;
  [[nodiscard]] double largest(std::size_t body) const override { return largest_[body]; }

 private:
  const BoundedMotion& motion_;
  std::vector<double> reach_;    ///< distance of each body's points from the origin of the body
  std::vector<double> largest_;  ///< bound on coordinates in the scene
};

}  // namespace blum::detail
