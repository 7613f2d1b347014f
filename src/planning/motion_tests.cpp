#include "planning/motion_tests.hpp"

#include <algorithm>
#include <cmath>

#include "blum/geometry/triangle_distance.hpp"

namespace blum::detail {
namespace {

/// The two meshes of a pair at a time, in the coordinates of the scene.
class PlacedPair {
 public:
  PlacedPair(const Bodies& data, const BodyPair& pair, std::span<const RigidTransform> poses)
      : body_(data.bodies[pair.body]), body_pose_(poses[pair.body]) {
    if (pair.other) {
      other_ = &data.bodies[*pair.other];
      other_pose_ = &poses[*pair.other];
      body_in_other_ = other_pose_->inverse() * body_pose_;
    } else {
      other_ = &*data.obstacles;
      body_in_other_ = body_pose_;
    }
  }

  using Corners = std::array<Vec3d, 3>;
  [[nodiscard]] Corners of_body(std::uint32_t primitive) const { return body_.corners(primitive, body_pose_); }
  [[nodiscard]] Corners of_other(std::uint32_t primitive) const {
    return other_pose_ != nullptr ? other_->corners(primitive, *other_pose_) : other_->corners(primitive);
  }
  [[nodiscard]] TriangleDistance distance(std::uint32_t other, std::uint32_t own) const {
    return triangle_distance(of_body(own), of_other(other));
  }
  void for_each_near_pair(double limit, OrientedBvh::Visit visit) const {
    other_->bvh().for_each_near_pair(body_.bvh(), body_in_other_, limit, visit);
  }

 private:
  const RigidMesh& body_;
  const RigidTransform& body_pose_;
  const RigidMesh* other_ = nullptr;
  const RigidTransform* other_pose_ = nullptr;  ///< null: obstacles rest
  RigidTransform body_in_other_;
};

/// Smallest and largest of some numbers.
struct Extent {
  double least = HUGE_VAL, most = -HUGE_VAL;
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

}  // namespace

double PairTwists::least_distance(const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b, const Vec3d& normal,
                                  double half) const {
  const double size = length(normal);
  if (!(size > 0)) return 0;
  const Vec3d unit = normal / size;
  Extent height_a, height_b, speed_a, speed_b;
  for (const Vec3d& p : a) {
    height_a.add(dot(unit, p - b[0]));
    speed_a.add(body ? dot(unit, (*body)(p)) : 0);
  }
  for (const Vec3d& p : b) {
    height_b.add(dot(unit, p - b[0]));
    speed_b.add(other ? dot(unit, (*other)(p)) : 0);
  }
  const double speed = std::max(speed_a.most - speed_b.least, speed_b.most - speed_a.least) + rounding;
  return height_a.least - height_b.most - half * (std::max(speed, 0.0) + 0.5 * half * acceleration);
}

/// Lengths below this, mesh units, are lost when they are squared.
constexpr double least_error = 1e-150;

MotionTests::MotionTests(const Bodies& data, const PosesOverTime& motion, const Context& context)
    : data_(data), motion_(motion), context_(context), poses_(data.bodies.size()) {
  for (const BodyPair& pair : data.pairs) {
    Bounds bounds{.speed = motion.speed(pair.body),
                  .error = motion.error(pair.body),
                  .size = data.bodies[pair.body].bounds().diagonal(),
                  .acceleration = motion.acceleration(pair.body)};
    double largest = motion.largest(pair.body);
    if (pair.other) {
      bounds.speed += motion.speed(*pair.other);
      bounds.error += motion.error(*pair.other);
      bounds.acceleration += motion.acceleration(*pair.other);
      bounds.size = std::min(bounds.size, data.bodies[*pair.other].bounds().diagonal());
      largest += motion.largest(*pair.other) + data.bodies[*pair.other].bounds().largest_coordinate();
    } else {
      largest += data.obstacles->bounds().largest_coordinate();
    }
    // Boxes of hierarchies and distances of primitives are rounded, too.
    bounds.error += 4e-14 * (largest + data.bodies[pair.body].bounds().largest_coordinate()) + least_error;
    bounds_.push_back(bounds);
  }
}

void MotionTests::move_to(double time) {
  if (time_ == time) return;
  throw_if_cancelled(context_);
  motion_.set_poses(time, poses_);
  time_ = time;
}

namespace {

/// Distances of the primitives of a pair during an interval.
class PairInterval {
 public:
  /// @param error  of distances, in both directions.
  PairInterval(const PlacedPair& placed, const PairTwists& twists, double half, double speed, double error)
      : placed_(placed), twists_(twists), half_(half), spread_(half * speed + 2 * error), error_(2 * error) {}

  /// Returns the largest possible change of distances, with rounding.
  [[nodiscard]] double spread() const { return spread_; }

  struct Bound {
    double least = 0;  ///< during the interval
    TriangleDistance now;
  };
  /// @param enough  a larger bound is not needed.
  [[nodiscard]] Bound bound(std::uint32_t other, std::uint32_t own, double enough) const {
    const PlacedPair::Corners a = placed_.of_body(own), b = placed_.of_other(other);
    Bound out{.now = triangle_distance(a, b)};
    out.least = out.now.distance - spread_;
    if (out.least > enough || out.now.distance == 0 || half_ > longest_with_velocities || !twists_.body) return out;
    const auto use = [&](const Vec3d& normal) {
      out.least = std::max(out.least, twists_.least_distance(a, b, normal, half_) - error_);
    };
    const Vec3d away = out.now.first_point - out.now.second_point;
    use(away);
    // Across a gap near rounding, the direction between the closest points is rounded, but not that of a face.
    for (const PlacedPair::Corners* face : {&a, &b}) {
      if (out.least > enough) return out;
      const Vec3d normal = cross((*face)[1] - (*face)[0], (*face)[2] - (*face)[0]);
      use(dot(normal, away) < 0 ? normal * -1.0 : normal);
    }
    return out;
  }

 private:
  /// Half of the longest interval for which velocities are compared. Most motions are proven by the distances of longer
  /// intervals. Their tests end at the first close pair, which mostly is the one of the last test.
  static constexpr double longest_with_velocities = 0x1p-7;

  const PlacedPair& placed_;
  const PairTwists& twists_;
  double half_, spread_, error_;
};

}  // namespace

PairTwists MotionTests::twists(std::size_t pair, double time) const {
  const BodyPair& bodies = data_.pairs[pair];
  PairTwists out{.body = motion_.twist(bodies.body, time),
                 .other = {},
                 .acceleration = bounds_[pair].acceleration,
                 .rounding = 1e-13 * bounds_[pair].speed};
  if (bodies.other) out.other = motion_.twist(*bodies.other, time);
  return out;
}

bool MotionTests::are_apart(std::size_t pair, const TimeInterval& at, double distance) {
  move_to(at.middle());
  ++count_;
  Bounds& bounds = bounds_[pair];
  const PlacedPair placed(data_, data_.pairs[pair], poses_);
  const PairTwists both = twists(pair, at.middle());
  const PairInterval interval(placed, both, at.half(), bounds.speed, bounds.error);
  const auto may_be_close = [&](std::uint32_t other, std::uint32_t own) {
    return !(interval.bound(other, own, distance).least > distance);
  };
  // Primitives that were close at another time are mostly close again.
  if (bounds.last && may_be_close(bounds.last->first, bounds.last->second)) return false;
  const double limit = distance + interval.spread() + bounds.error;
  bool is_found = false;
  placed.for_each_near_pair(limit, [&](std::uint32_t other, std::uint32_t own, double) -> OrientedBvh::Wanted {
    if (!may_be_close(other, own)) return limit;
    bounds.last = {other, own};
    is_found = true;
    return -1.0;
  });
  return !is_found;
}

MotionTests::Least MotionTests::least_during(std::size_t pair, const TimeInterval& at, double limit) {
  move_to(at.middle());
  ++count_;
  Bounds& bounds = bounds_[pair];
  const PlacedPair placed(data_, data_.pairs[pair], poses_);
  const PairTwists both = twists(pair, at.middle());
  const PairInterval interval(placed, both, at.half(), bounds.speed, bounds.error);
  Least out{.bound = limit, .closest = {}};
  const auto compare = [&](std::uint32_t other, std::uint32_t own) {
    const PairInterval::Bound found = interval.bound(other, own, out.bound);
    out.bound = std::min(out.bound, found.least);
    if (out.closest && !(found.now.distance < out.closest->distance)) return;
    out.closest = named(pair, other, own, found.now);
    bounds.last = {other, own};
  };
  if (bounds.last) compare(bounds.last->first, bounds.last->second);
  // Primitives beyond this distance have a larger bound.
  const auto reach = [&] { return out.bound + interval.spread() + bounds.error; };
  placed.for_each_near_pair(reach(), [&](std::uint32_t other, std::uint32_t own, double) -> OrientedBvh::Wanted {
    compare(other, own);
    return out.closest->distance == 0 ? -1.0 : reach();
  });
  return out;
}

MotionPair MotionTests::named(std::size_t pair, std::uint32_t other, std::uint32_t own,
                              const TriangleDistance& between) const {
  const BodyPair& bodies = data_.pairs[pair];
  MotionPair out{.body = static_cast<std::uint32_t>(bodies.body),
                 .primitive = own,
                 .other_primitive = other,
                 .distance = between.distance,
                 .on_body = between.first_point,
                 .on_other = between.second_point};
  if (bodies.other) {
    out.other_body = static_cast<std::uint32_t>(*bodies.other);
  } else {
    data_.name_obstacle(other, out);
  }
  return out;
}

std::optional<MotionPair> MotionTests::closest(std::size_t pair, double time, double distance) {
  move_to(time);
  ++count_;
  Bounds& bounds = bounds_[pair];
  const PlacedPair placed(data_, data_.pairs[pair], poses_);
  std::optional<TriangleDistance> best;
  double limit = distance;
  const auto compare = [&](std::uint32_t other, std::uint32_t own) {
    const TriangleDistance found = placed.distance(other, own);
    if (!(found.distance <= limit && (!best || found.distance < best->distance))) return;
    best = found;
    limit = found.distance;
    bounds.last = {other, own};
  };
  if (bounds.last) compare(bounds.last->first, bounds.last->second);
  placed.for_each_near_pair(limit + bounds.error,
                            [&](std::uint32_t other, std::uint32_t own, double) -> OrientedBvh::Wanted {
                              compare(other, own);
                              return limit == 0 ? -1.0 : limit + bounds.error;
                            });
  if (!best) return std::nullopt;
  return named(pair, bounds.last->first, bounds.last->second, *best);
}

std::optional<MotionPair> MotionTests::closest(double time, double distance) {
  std::optional<MotionPair> best;
  for (std::size_t pair = 0; pair < pairs(); ++pair) {
    const auto found = closest(pair, time, best ? best->distance : distance);
    if (found && (!best || found->distance < best->distance)) best = found;
  }
  return best;
}

namespace {

/// Finds the first interval that cannot be proven.
class DoubtSearch {
 public:
  DoubtSearch(MotionTests& tests, double clearance, std::span<const double> delta)
      : tests_(tests), clearance_(clearance), delta_(delta), open_(tests.pairs()) {
    for (std::size_t k = 0; k < open_.size(); ++k) open_[k] = k;
  }

  std::optional<Doubt> first(const TimeInterval& of) { return first(0, of); }

 private:
  /// @param begin  of the pairs in open_, up to its end, that are not proven for the whole interval.
  std::optional<Doubt> first(std::size_t begin, const TimeInterval& of) {
    const std::size_t end = open_.size();
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t pair = open_[k];
      if (tests_.are_apart(pair, of, clearance_)) continue;
      const double reach = of.half() * tests_.speed(pair) + 2 * tests_.error(pair);
      if (reach < delta_[pair] || of.is_single()) return Doubt{of, pair};
      open_.push_back(pair);
    }
    if (open_.size() == end) return std::nullopt;
    if (const auto found = first(end, {of.from, of.middle()})) return found;
    const auto found = first(end, {of.middle(), of.to});
    open_.resize(end);
    return found;
  }

  MotionTests& tests_;
  double clearance_;
  std::span<const double> delta_;
  std::vector<std::size_t> open_;  ///< a stack: each level of the recursion adds the pairs that stay open
};

}  // namespace

std::optional<Doubt> first_doubt(MotionTests& tests, double clearance, std::span<const double> delta, TimeInterval of) {
  return DoubtSearch(tests, clearance, delta).first(of);
}

std::optional<std::pair<double, MotionPair>> contact_after(MotionTests& tests, const TimeInterval& doubt) {
  double step = 0;
  for (double time = doubt.middle(); time <= 1; time = doubt.middle() + step) {
    const auto pair = tests.closest(time, 0);
    if (pair && pair->distance == 0) return std::pair(time, *pair);
    step = step == 0 ? std::max(doubt.to - doubt.from, 0x1p-40) : 2 * step;
  }
  const auto pair = tests.closest(1, 0);
  if (pair && pair->distance == 0) return std::pair(1.0, *pair);
  return std::nullopt;
}

}  // namespace blum::detail
