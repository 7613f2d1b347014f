#include "blum/planning/certified_path.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "planning/bodies.hpp"
#include "planning/least_clearance.hpp"
#include "planning/motion_tests.hpp"
#include "planning/pose_sources.hpp"

namespace blum {
namespace {

/// Motion of all bodies between two waypoints.
std::vector<RigidMotion> motions_between(const MotionPath& path, std::size_t from, std::size_t to) {
  std::vector<RigidMotion> out;
  for (std::size_t body = 0; body < path.centres.size(); ++body) {
    out.emplace_back(path.poses[from][body], path.poses[to][body], path.centres[body]);
  }
  return out;
}

void check(const MotionPath& path, std::size_t bodies) {
  if (path.poses.empty()) throw InvalidOption("path: there is no waypoint; give at least one");
  if (path.centres.size() != bodies) {
    throw InvalidOption("path: there are " + std::to_string(path.centres.size()) + " centres for " +
                        std::to_string(bodies) + " bodies; give one for each body");
  }
  for (std::size_t k = 0; k < path.poses.size(); ++k) {
    if (path.poses[k].size() == bodies) continue;
    throw InvalidOption("path: waypoint " + std::to_string(k) + " has " + std::to_string(path.poses[k].size()) +
                        " poses for " + std::to_string(bodies) + " bodies; give one for each body");
  }
}

/// Merges the intervals of all pairs of one motion: the bound of each part is the smallest of all pairs.
/// @param intervals  of one motion.
std::vector<PathInterval> merged(std::span<const detail::ProvenInterval> intervals, std::uint32_t edge) {
  std::vector<double> ends{0, 1};
  for (const detail::ProvenInterval& interval : intervals) ends.push_back(interval.at.to);
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<PathInterval> out;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    out.push_back({.edge = edge, .from = ends[k], .to = ends[k + 1], .clearance = HUGE_VAL});
  }
  for (const detail::ProvenInterval& interval : intervals) {
    const auto first = std::lower_bound(ends.begin(), ends.end(), interval.at.from) - ends.begin();
    for (auto k = static_cast<std::size_t>(first); k < out.size() && out[k].to <= interval.at.to; ++k) {
      out[k].clearance = std::min(out[k].clearance, interval.clearance);
    }
  }
  return out;
}

}  // namespace

/// Certifies the motions of a path one after the other, then their smallest clearance.
class PathCertifier {
 public:
  PathCertifier(const MotionCertifier& certifier, const MotionPath& path, const Context& context)
      : certifier_(certifier), context_(context) {
    check(path, certifier.size());
    const std::size_t count = std::max<std::size_t>(path.edges(), 1);
    for (std::size_t k = 0; k < count; ++k) {
      motions_.push_back(motions_between(path, k, std::min(k + 1, path.poses.size() - 1)));
    }
  }

  CertifiedPath run(const PathOptions& options) {
    CertifiedPath out;
    if (!all_free({.clearance = options.clearance, .delta = options.delta}, out)) return out;
    const detail::LeastClearance found = least_clearance(options.tolerance, out);
    out.at_least = std::max(found.at_least, options.clearance);
    out.at_most = found.closest ? std::max(found.closest->distance, out.at_least) : out.at_least;
    out.edge = static_cast<std::uint32_t>(found.motion);
    out.time = found.time;
    out.closest = found.closest;
    set_intervals(found, options.clearance, out);
    return out;
  }

 private:
  /// Returns true if all motions keep the clearance; otherwise sets the answer.
  bool all_free(const MotionOptions& options, CertifiedPath& out) const {
    for (std::size_t k = 0; k < motions_.size(); ++k) {
      const CertifiedMotion found = certifier_.certify(motions_[k], options, context_);
      out.tests += found.tests;
      if (context_.progress) {
        context_.progress(static_cast<double>(k + 1) / static_cast<double>(motions_.size()), "motions");
      }
      if (found.verdict == MotionVerdict::free) continue;
      out.verdict = found.verdict;
      out.edge = static_cast<std::uint32_t>(k);
      out.time = found.time;
      out.closest = found.closest;
      return false;
    }
    return true;
  }

  detail::LeastClearance least_clearance(double tolerance, CertifiedPath& out) const {
    std::vector<std::unique_ptr<detail::RigidMotions>> poses;
    std::vector<detail::MotionTests> tests;
    for (const std::vector<RigidMotion>& motions : motions_) {
      poses.push_back(std::make_unique<detail::RigidMotions>(*certifier_.bodies_, motions));
      tests.emplace_back(*certifier_.bodies_, *poses.back(), context_);
    }
    detail::LeastClearance found = detail::least_clearance(tests, tolerance);
    for (const detail::MotionTests& one : tests) out.tests += one.count();
    return found;
  }

  /// @param clearance  that is proven for the whole path.
  static void set_intervals(const detail::LeastClearance& found, double clearance, CertifiedPath& out) {
    std::vector<detail::ProvenInterval> sorted = found.intervals;
    std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
      return std::pair(a.motion, a.at.from) < std::pair(b.motion, b.at.from);
    });
    for (std::size_t begin = 0; begin < sorted.size();) {
      std::size_t end = begin;
      while (end < sorted.size() && sorted[end].motion == sorted[begin].motion) ++end;
      const std::span<const detail::ProvenInterval> of_motion(sorted.data() + begin, end - begin);
      for (PathInterval interval : merged(of_motion, static_cast<std::uint32_t>(sorted[begin].motion))) {
        interval.clearance = std::max(interval.clearance, clearance);
        out.intervals.push_back(interval);
      }
      begin = end;
    }
  }

  const MotionCertifier& certifier_;
  const Context& context_;
  std::vector<std::vector<RigidMotion>> motions_;
};

CertifiedPath certify_path(const MotionCertifier& certifier, const MotionPath& path, const PathOptions& options,
                           const Context& context) {
  detail::check_tolerance(options.tolerance);
  return PathCertifier(certifier, path, context).run(options);
}

RigidTransform pose_of(const PoseNumbers& numbers) {
  for (const double number : numbers) {
    if (std::isfinite(number)) continue;
    throw InvalidOption("pose: a number is not finite; give x, y, z and a quaternion w, x, y, z");
  }
  const auto& [tx, ty, tz, qw, qx, qy, qz] = numbers;
  const double size = std::sqrt(qw * qw + qx * qx + qy * qy + qz * qz);
  constexpr double most = 1e-3;
  if (!(std::abs(size - 1) <= most)) {
    throw InvalidOption("pose: the length of the quaternion is " + exact_text(size) +
                        ", but must be 1; its order is w, x, y, z");
  }
  const double w = qw / size, x = qx / size, y = qy / size, z = qz / size;
  RigidTransform out;
  out.rotation.columns[0] = {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)};
  out.rotation.columns[1] = {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)};
  out.rotation.columns[2] = {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)};
  out.translation = {tx, ty, tz};
  return out;
}

PoseNumbers numbers_of(const RigidTransform& pose) {
  // The motion from the identity has the axis and the angle of the rotation, precise at all angles.
  RigidTransform turn;
  turn.rotation = pose.rotation;
  const RigidMotion motion({}, turn, {});
  const Vec3d v = motion.axis() * std::sin(motion.angle() / 2);
  const Vec3d& t = pose.translation;
  return {t.x, t.y, t.z, std::cos(motion.angle() / 2), v.x, v.y, v.z};
}

}  // namespace blum
