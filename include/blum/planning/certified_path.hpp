// Blum: paths of rigid bodies that are proven free of contact. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/rigid_transform.hpp"
#include "blum/planning/certified_motion.hpp"

namespace blum {

/// Pose as numbers: x, y, z of the translation, then w, x, y, z of a quaternion.
using PoseNumbers = std::array<double, 7>;

/// Returns the pose with these numbers. The quaternion is divided by its length.
/// @throws InvalidOption if a number is not finite, or if the length of the quaternion differs from 1 by more than
/// 1e-3.
[[nodiscard]] RigidTransform pose_of(const PoseNumbers& numbers);
/// Returns the numbers of a pose. The quaternion has length 1, and its w is not negative.
[[nodiscard]] PoseNumbers numbers_of(const RigidTransform& pose);

/// Path of one or several bodies through waypoints. Between consecutive waypoints, each body moves as RigidMotion
/// states: its centre moves along a straight line, and it turns at a constant speed.
struct MotionPath {
  std::vector<Vec3d> centres;                      ///< For each body: its centre, in its coordinates.
  std::vector<std::vector<RigidTransform>> poses;  ///< For each waypoint: the pose of each body in the scene.

  /// Returns the number of motions between waypoints.
  [[nodiscard]] std::size_t edges() const { return poses.empty() ? 0 : poses.size() - 1; }
};

/// Part of a path, with a lower bound of the distance between surfaces.
struct PathInterval {
  std::uint32_t edge = 0;  ///< Number of the motion between waypoints `edge` and `edge` + 1.
  double from = 0;         ///< Times of the motion, 0 to 1.
  double to = 1;
  double clearance = 0;  ///< From `from` to `to`, the surfaces are at least this far apart, mesh units.
};

template <>
struct Description<PathInterval> {
  static constexpr std::string_view name = "PathInterval";
  static constexpr std::string_view doc = "Part of a path, with a lower bound of the distance between surfaces";
  static constexpr std::tuple members{
      Member{"edge", &PathInterval::edge, "", "number of the motion between two waypoints"},
      Member{"start", &PathInterval::from, "", "first time of the part, 0 to 1"},
      Member{"end", &PathInterval::to, "", "last time of the part, 0 to 1"},
      Member{"clearance", &PathInterval::clearance, "mesh units", "the surfaces are at least this far apart"},
  };
};

struct PathOptions {
  double clearance = 0;  ///< The surfaces must stay further apart than this distance, >= 0, mesh units.
  /// A path that comes closer than the clearance plus this distance may be too close, > 0, mesh units. If not given,
  /// it is 1e-6 of the size of the smallest body.
  std::optional<double> delta = {};
  /// Largest relative difference of the bounds of the path's clearance, above 0 and below 1.
  double tolerance = 0.05;
};

template <>
struct Description<PathOptions> {
  static constexpr std::string_view name = "PathOptions";
  static constexpr std::string_view doc = "Clearance of a path that must be proven";
  static constexpr std::tuple members{
      Member{"clearance", &PathOptions::clearance, "mesh units", "distance that the surfaces must keep",
             Range::at_least(0)},
      Member{"delta", &PathOptions::delta, "mesh units",
             "paths that come closer than the clearance plus this distance may be too close; default: 1e-6 of the "
             "size of the smallest body",
             Range::positive()},
      Member{"tolerance", &PathOptions::tolerance, "of the clearance",
             "largest difference of the bounds of the path's clearance"},
  };
};

struct CertifiedPath {
  MotionVerdict verdict = MotionVerdict::free;
  double at_least = 0;     ///< If free: the surfaces stay at least this far apart, mesh units.
  double at_most = 0;      ///< If free: their distance at the narrowest place, mesh units.
  std::uint32_t edge = 0;  ///< Motion with the narrowest place. If not free: the first motion that is not free.
  double time = 0;         ///< Time of this motion at which the narrowest place or the verdict is found, 0 to 1.
  std::optional<MotionPair> closest = {};  ///< Closest pair at this time.
  std::vector<PathInterval> intervals;     ///< If free: the proof. The intervals of each motion cover 0 to 1.
  std::size_t tests = 0;                   ///< Comparisons of two objects at a time.
};

template <>
struct Description<CertifiedPath> {
  static constexpr std::string_view name = "CertifiedPath";
  static constexpr std::string_view doc = "Answer about a path";
  static constexpr std::tuple members{
      Member{"verdict", &CertifiedPath::verdict, "",
             "free: it keeps the clearance at all times; too_close: the surfaces are closer than the clearance plus "
             "delta; colliding: they meet"},
      Member{"at_least", &CertifiedPath::at_least, "mesh units", "if free: the surfaces stay at least this far apart"},
      Member{"at_most", &CertifiedPath::at_most, "mesh units", "if free: their distance at the narrowest place"},
      Member{"edge", &CertifiedPath::edge, "",
             "motion with the narrowest place; if not free: the first motion that is not free"},
      Member{"time", &CertifiedPath::time, "", "time of this motion, 0 to 1"},
      Member{"closest", &CertifiedPath::closest, "", "closest pair at this time"},
      Member{"intervals", &CertifiedPath::intervals, "", "if free: the proof; the parts of each motion cover 0 to 1"},
      Member{"tests", &CertifiedPath::tests, "", "comparisons of two objects at a time"},
  };
};

/// Returns a proof that a path keeps its clearance, or the first motion that may not.
/// @param certifier  has as many bodies as the path.
/// @throws InvalidOption if the path has no waypoint, another number of bodies, or a pose that RigidMotion rejects, or
/// if an option is out of range; Cancelled.
/// Cost: a few times that of MotionCertifier::certify() for each motion. Progress counts motions.
[[nodiscard]] CertifiedPath certify_path(const MotionCertifier& certifier, const MotionPath& path,
                                         const PathOptions& options = {}, const Context& context = {});

}  // namespace blum
