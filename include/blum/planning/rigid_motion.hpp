// Blum: rigid motions between two poses. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/vec3.hpp"
#include "blum/geometry/rigid_transform.hpp"

namespace blum {

/// Motion of a rigid body from time 0 to time 1. A centre moves along a straight line at a constant speed. The body
/// turns about the centre, by at most 180 degrees, about a fixed axis at a constant speed.
class RigidMotion {
 public:
  /// Constructs the motion between two poses, which map the body to the scene.
  /// @param from, to  poses at times 0 and 1. Their rotations are replaced by the closest rotations.
  /// @param centre    point of the body, in its coordinates, mesh units.
  /// @throws InvalidOption if a pose is not finite, or its rotation_error() is above 1e-9, or it mirrors.
  RigidMotion(const RigidTransform& from, const RigidTransform& to, const Vec3d& centre);

  /// Returns the pose at a time, 0 to 1. The error of positions is at most rounding() for a point.
  [[nodiscard]] RigidTransform at(double time) const;

  [[nodiscard]] const Vec3d& centre() const { return centre_; }
  /// Returns the direction of the axis of rotation in the coordinates of the body, a unit vector.
  [[nodiscard]] const Vec3d& axis() const { return axis_; }
  /// Returns the angle of the whole rotation, 0 to pi, radians.
  [[nodiscard]] double angle() const { return angle_; }
  /// Returns the position of the centre in the scene at a time, mesh units.
  [[nodiscard]] Vec3d centre_at(double time) const { return start_ + velocity() * time; }
  /// Returns the velocity of the centre, mesh units per unit of time.
  [[nodiscard]] Vec3d velocity() const { return end_ - start_; }
  /// Returns the angular velocity in the scene, radians per unit of time. It does not change with time.
  [[nodiscard]] Vec3d angular_velocity() const { return rotation_ * axis_ * angle_; }
  /// Returns a bound on the speed of a point of the body, mesh units per unit of time.
  /// @param radius  distance of the point from the axis of rotation through the centre.
  [[nodiscard]] double speed(double radius) const { return length(velocity()) + angle_ * radius; }
  /// Returns a bound on the difference between a point's exact position and its position by at(), mesh units. It covers
  /// rounding of the transform and of its application.
  /// @param radius  distance of the point from the centre.
  [[nodiscard]] double rounding(double radius) const;

 private:
  Mat3 rotation_;  ///< at time 0
  Vec3d centre_;
  Vec3d start_;  ///< of the centre, in the scene
  Vec3d end_;
  Vec3d axis_;
  double angle_ = 0;
};

}  // namespace blum
