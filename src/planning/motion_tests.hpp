// Blum: distances between bodies that move, with bounds over time. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/rigid_transform.hpp"
#include "blum/geometry/triangle_distance.hpp"
#include "blum/planning/certified_motion.hpp"
#include "planning/bodies.hpp"

namespace blum::detail {

/// Part of the time of a motion.
struct TimeInterval {
  double from = 0, to = 1;
  [[nodiscard]] double middle() const { return from + 0.5 * (to - from); }
  [[nodiscard]] double half() const { return 0.5 * (to - from); }
  /// Returns true if the interval cannot be halved in doubles.
  [[nodiscard]] bool is_single() const { return middle() <= from || middle() >= to; }
};

/// Velocities of a rigid body at a time: the velocity of a point x is linear + cross(angular, x - centre).
struct Twist {
  Vec3d linear;   ///< of the centre, mesh units per unit of time
  Vec3d angular;  ///< radians per unit of time
  Vec3d centre;   ///< in the scene
  [[nodiscard]] Vec3d operator()(const Vec3d& x) const { return linear + cross(angular, x - centre); }
};

/// Velocities of a pair of bodies at a time.
struct PairTwists {
  std::optional<Twist> body, other;
  double acceleration = 0;  ///< bound on that of all points, sum of both bodies
  double rounding = 0;      ///< of velocities

  /// Returns a lower bound of the distance of two convex hulls during an interval around the time, at which their
  /// corners are given. The bound uses a plane between them: only velocities across the plane count.
  /// @param normal  of the plane, from `b` to `a`, of any length. Any normal gives a valid bound.
  [[nodiscard]] double least_distance(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b, const Vec3d& normal,
                                      double half) const;
};

/// Poses of bodies over time, with bounds for each body.
class PosesOverTime {
 public:
  PosesOverTime() = default;
  PosesOverTime(const PosesOverTime&) = delete;
  PosesOverTime& operator=(const PosesOverTime&) = delete;
  virtual ~PosesOverTime() = default;
  virtual void set_poses(double time, std::span<RigidTransform> poses) const = 0;
  /// Returns a bound on the displacement of each point of a body, mesh units per unit of time.
  [[nodiscard]] virtual double speed(std::size_t body) const = 0;
  /// Returns the velocities of a body at a time, if they are known.
  [[nodiscard]] virtual std::optional<Twist> twist(std::size_t body, double time) const = 0;
  /// Returns a bound on the acceleration of each point of a body, if velocities are known.
  [[nodiscard]] virtual double acceleration(std::size_t body) const = 0;
  /// Returns a bound on the error of positions of a body's vertices, mesh units.
  [[nodiscard]] virtual double error(std::size_t body) const = 0;
  /// Returns a bound on the coordinates of a body in the scene at any time, mesh units.
  [[nodiscard]] virtual double largest(std::size_t body) const = 0;
};

/// The tests of one motion. A pair is an index into the pairs of the certifier.
class MotionTests {
 public:
  MotionTests(const Bodies& data, const PosesOverTime& motion, const Context& context);

  [[nodiscard]] std::size_t pairs() const { return bounds_.size(); }
  /// Returns a bound on the change of a pair's distance, mesh units per unit of time.
  [[nodiscard]] double speed(std::size_t pair) const { return bounds_[pair].speed; }
  /// Returns a bound on the difference between exact and computed distances of a pair, mesh units.
  [[nodiscard]] double error(std::size_t pair) const { return bounds_[pair].error; }
  /// Returns the smallest diagonal of the boxes around the moving bodies of a pair, mesh units.
  [[nodiscard]] double size(std::size_t pair) const { return bounds_[pair].size; }
  [[nodiscard]] std::size_t count() const { return count_; }

  /// Returns true if the surfaces of a pair are proven to be further apart than a distance during an interval.
  bool are_apart(std::size_t pair, const TimeInterval& at, double distance);
  /// Distance of a pair during an interval.
  struct Least {
    double bound = 0;                        ///< lower bound of the distance during the interval
    std::optional<MotionPair> closest = {};  ///< at its middle, if it is within the limit
  };
  /// Returns a lower bound of the distance of a pair during an interval.
  /// @param limit  a larger bound is not needed.
  Least least_during(std::size_t pair, const TimeInterval& at, double limit);
  /// Returns the closest primitives of a pair at a time, if they are at most a distance apart.
  std::optional<MotionPair> closest(std::size_t pair, double time, double distance);
  /// Returns the closest primitives of all pairs at a time, if they are at most a distance apart.
  std::optional<MotionPair> closest(double time, double distance);

 private:
  struct Bounds {
    double speed = 0, error = 0, size = 0;
    double acceleration = 0;                                           ///< sum of the bodies
    std::optional<std::pair<std::uint32_t, std::uint32_t>> last = {};  ///< primitives that were close: other, body
  };
  void move_to(double time);
  [[nodiscard]] PairTwists twists(std::size_t pair, double time) const;
  [[nodiscard]] MotionPair named(std::size_t pair, std::uint32_t other, std::uint32_t own,
                                 const TriangleDistance& between) const;

  const Bodies& data_;
  const PosesOverTime& motion_;
  const Context& context_;
  std::vector<Bounds> bounds_;
  std::vector<RigidTransform> poses_;
  std::optional<double> time_;  ///< of poses_
  std::size_t count_ = 0;
};

/// Interval that is not proven, and the first pair whose surfaces are close at its middle.
struct Doubt {
  TimeInterval at;
  std::size_t pair = 0;
};

/// Returns the first interval that cannot be proven to keep a clearance; nothing if the whole motion keeps it.
/// @param delta  for each pair: the distance above the clearance that need not be proven.
std::optional<Doubt> first_doubt(MotionTests& tests, double clearance, std::span<const double> delta,
                                 TimeInterval of = {});

/// Returns a time at which the surfaces meet, at or soon after an interval in doubt.
std::optional<std::pair<double, MotionPair>> contact_after(MotionTests& tests, const TimeInterval& doubt);

}  // namespace blum::detail
