#include "blum/planning/certified_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/sort_unique.hpp"
#include "blum/geometry/oriented_bvh.hpp"
#include "blum/geometry/primitives.hpp"
#include "blum/geometry/triangle_distance.hpp"

namespace blum {
namespace {

/// A mesh that does not deform, with a hierarchy over it.
class RigidMesh {
 public:
  RigidMesh(const MeshView& mesh, const Context& context)
      : vertices_(mesh.vertices.begin(), mesh.vertices.end()), bvh_(mesh, context) {
    for (std::uint32_t k = 0; k < bvh_.size(); ++k) primitives_.push_back(primitive_vertices(mesh, k));
    constexpr std::size_t many = 1024;
    if (3 * primitives_.size() > many) {
      for (unsigned k = 0; k < 8; ++k) {
        const auto side = [&](std::size_t axis) {
          return (k >> axis & 1U) != 0 ? bounds().upper[axis] : bounds().lower[axis];
        };
        hull_points_.push_back({side(0), side(1), side(2)});
      }
      return;
    }
    std::vector<std::uint32_t> used;
    for (const std::array<std::uint32_t, 3>& corners : primitives_)
      used.insert(used.end(), corners.begin(), corners.end());
    detail::sort_unique(used);
    for (const std::uint32_t v : used) hull_points_.push_back(vertices_[v]);
  }

  [[nodiscard]] const OrientedBvh& bvh() const { return bvh_; }
  [[nodiscard]] const Box3& bounds() const { return bvh_.bounds(); }
  [[nodiscard]] std::array<Vec3d, 3> corners(std::uint32_t primitive) const {
    const auto& [a, b, c] = primitives_[primitive];
    return {vertices_[a], vertices_[b], vertices_[c]};
  }
  [[nodiscard]] std::array<Vec3d, 3> corners(std::uint32_t primitive, const RigidTransform& pose) const {
    const auto& [a, b, c] = primitives_[primitive];
    return {pose(vertices_[a]), pose(vertices_[b]), pose(vertices_[c])};
  }

  /// Returns points whose convex hull contains the mesh: its vertices, or the corners of its box if it has many.
  [[nodiscard]] const std::vector<Vec3d>& hull_points() const { return hull_points_; }

 private:
  std::vector<Vec3d> vertices_;
  std::vector<std::array<std::uint32_t, 3>> primitives_;
  std::vector<Vec3d> hull_points_;
  OrientedBvh bvh_;
};

void check_coordinates(const MeshView& mesh, const char* name) {
  constexpr double furthest = 1e70;
  validate(mesh);
  for (const Vec3d& p : mesh.vertices) {
    if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= furthest) continue;
    throw InvalidMesh(std::string("motion: a coordinate of the ") + name + " is beyond 1e70; use other units");
  }
}

}  // namespace

struct MotionCertifier::Data {
  RigidMesh body;
  RigidMesh obstacles;
};

namespace {

/// The tests of one motion.
class MotionTests {
 public:
  MotionTests(const RigidMesh& body, const RigidMesh& obstacles, const RigidMotion& motion, const Context& context)
      : body_(body), obstacles_(obstacles), motion_(motion), context_(context) {
    double from_axis = 0, from_centre = 0;  // squared
    for (const Vec3d& p : body.hull_points()) {
      const Vec3d step = p - motion.centre();
      from_axis = std::max(from_axis, squared_length(cross(motion.axis(), step)));
      from_centre = std::max(from_centre, squared_length(step));
    }
    constexpr double rounding = 1 + 1e-14;
    speed_ = rounding * motion.speed(std::sqrt(from_axis));
    // Boxes of hierarchies and distances of primitives are rounded, too.
    const double reach = std::sqrt(from_centre);
    const double largest = obstacles.bounds().largest_coordinate() + reach + length(motion.at(0).translation) +
                           length(motion.at(1).translation) + length(motion.centre());
    error_ = motion.rounding(reach) + 4e-14 * largest;
  }

  /// Returns a bound on the way of all points of the body, mesh units per unit of time.
  [[nodiscard]] double speed() const { return speed_; }
  /// Returns a bound on the difference between exact and computed distances, mesh units.
  [[nodiscard]] double error() const { return error_; }
  [[nodiscard]] std::size_t count() const { return count_; }

  /// Returns true if the surfaces are further apart than a distance at a time.
  bool are_apart(double time, double distance) {
    throw_if_cancelled(context_);
    ++count_;
    const RigidTransform pose = motion_.at(time);
    const auto is_close = [&](std::uint32_t obstacle, std::uint32_t own) {
      return triangle_distance(obstacles_.corners(obstacle), body_.corners(own, pose)).distance <= distance;
    };
    // A pair that was close at another time is mostly close again.
    if (last_ && is_close(last_->first, last_->second)) return false;
    bool is_found = false;
    obstacles_.bvh().for_each_near_pair(body_.bvh(), pose, distance + error_,
                                        [&](std::uint32_t obstacle, std::uint32_t own, double) -> OrientedBvh::Wanted {
                                          if (!is_close(obstacle, own)) return distance + error_;
                                          last_ = {obstacle, own};
                                          is_found = true;
                                          return -1.0;
                                        });
    return !is_found;
  }

  /// Returns the closest pair at a time, among pairs that are at most a distance apart.
  [[nodiscard]] std::optional<MotionPair> closest(double time, double distance) const {
    const RigidTransform pose = motion_.at(time);
    std::optional<MotionPair> best;
    double limit = distance;
    obstacles_.bvh().for_each_near_pair(
        body_.bvh(), pose, limit + error_,
        [&](std::uint32_t obstacle, std::uint32_t own, double) -> OrientedBvh::Wanted {
          const TriangleDistance found = triangle_distance(body_.corners(own, pose), obstacles_.corners(obstacle));
          if (found.distance <= limit && (!best || found.distance < best->distance)) {
            best = MotionPair{own, obstacle, found.distance, found.first_point, found.second_point};
            limit = found.distance;
          }
          return limit == 0 ? -1.0 : limit + error_;
        });
    return best;
  }

 private:
  const RigidMesh& body_;
  const RigidMesh& obstacles_;
  const RigidMotion& motion_;
  const Context& context_;
  double speed_ = 0;
  double error_ = 0;
  std::size_t count_ = 0;
  std::optional<std::pair<std::uint32_t, std::uint32_t>> last_;  ///< an obstacle and a primitive of the body
};

/// An interval of time that is not proven free, and at whose middle the surfaces are close.
struct Doubt {
  double from = 0, to = 1;
  [[nodiscard]] double middle() const { return from + 0.5 * (to - from); }
};

/// Returns the first interval that stays in doubt; nothing if the whole motion is free.
std::optional<Doubt> first_doubt(MotionTests& tests, double clearance, double delta, const Doubt& of) {
  const double half = 0.5 * (of.to - of.from) * tests.speed();
  if (tests.are_apart(of.middle(), clearance + half + 2 * tests.error())) return std::nullopt;
  const bool is_short = half + 2 * tests.error() < delta;
  const bool is_single = of.middle() <= of.from || of.middle() >= of.to;
  if (is_short || is_single) return of;
  if (const auto first = first_doubt(tests, clearance, delta, {of.from, of.middle()})) return first;
  return first_doubt(tests, clearance, delta, {of.middle(), of.to});
}

/// Returns a time at which the surfaces meet, at or soon after an interval in doubt.
std::optional<std::pair<double, MotionPair>> contact_after(const MotionTests& tests, const Doubt& doubt) {
  double step = 0;
  for (double time = doubt.middle(); time <= 1; time = doubt.middle() + step) {
    const auto pair = tests.closest(time, 0);
    if (pair && pair->distance == 0) return std::pair(time, *pair);
    step = step == 0 ? std::max(doubt.to - doubt.from, 0x1p-40) : 2 * step;
  }
  return std::nullopt;
}

void check(const MotionOptions& options) {
  if (!(options.clearance >= 0 && std::isfinite(options.clearance))) {
    throw InvalidOption("motion: clearance must be 0 or more, not " + exact_text(options.clearance));
  }
  if (options.delta && !(*options.delta > 0 && std::isfinite(*options.delta))) {
    throw InvalidOption("motion: delta must be positive, not " + exact_text(*options.delta));
  }
}

}  // namespace

MotionCertifier::MotionCertifier(const MeshView& body, const MeshView& obstacles, const Context& context) {
  check_coordinates(body, "body");
  check_coordinates(obstacles, "obstacles");
  data_ = std::make_unique<Data>(Data{RigidMesh(body, context), RigidMesh(obstacles, context)});
}

MotionCertifier::MotionCertifier(MotionCertifier&&) noexcept = default;
MotionCertifier& MotionCertifier::operator=(MotionCertifier&&) noexcept = default;
MotionCertifier::~MotionCertifier() = default;

Vec3d MotionCertifier::centre() const {
  return data_->body.bounds().center();
}

CertifiedMotion MotionCertifier::certify(const RigidMotion& motion, const MotionOptions& options,
                                         const Context& context) const {
  check(options);
  throw_if_cancelled(context);
  CertifiedMotion out;
  MotionTests tests(data_->body, data_->obstacles, motion, context);
  const Box3& box = data_->body.bounds();
  const double smallest = 8 * tests.error();
  const double delta = std::max(options.delta ? *options.delta : 1e-6 * box.diagonal(), smallest);
  const std::optional<Doubt> doubt = first_doubt(tests, options.clearance, delta, {});
  out.tests = tests.count();
  if (!doubt) {
    out.free_until = 1;
    return out;
  }
  out.free_until = doubt->from;
  if (auto contact = contact_after(tests, *doubt)) {
    out.verdict = MotionVerdict::colliding;
    out.time = contact->first;
    out.closest = contact->second;
    return out;
  }
  out.verdict = MotionVerdict::too_close;
  out.time = doubt->middle();
  out.closest = tests.closest(out.time, options.clearance + delta);
  return out;
}

CertifiedMotion certify_motion(const MeshView& body, const MeshView& obstacles, const RigidMotion& motion,
                               const MotionOptions& options, const Context& context) {
  return MotionCertifier(body, obstacles, context).certify(motion, options, context);
}

}  // namespace blum
