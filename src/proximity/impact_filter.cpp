#include "proximity/impact_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "blum/core/inline_list.hpp"
#include "blum/core/vec3.hpp"
#include "proximity/exact/shifted_impact.hpp"

namespace blum::detail {
namespace {

/// A point of each of two features, approximately the closest ones. The rounding errors of these points are small
/// compared to the features. If features are thin, the points need not be the closest points.
struct ClosestPair {
  Vec3d first;
  Vec3d second;
};

/// Returns the point of the segment from the origin to `end` that is closest to `to`.
Vec3d on_segment(const Vec3d& end, const Vec3d& to) {
  const double square = squared_length(end);
  return square > 0 ? end * std::clamp(dot(end, to) / square, 0.0, 1.0) : Vec3d{};
}

/// Returns the closest points of a point and the triangle with corners at the origin, b and c.
ClosestPair closest_of_point_and_triangle(const Vec3d& point, const Vec3d& b, const Vec3d& c) {
  const Vec3d normal = cross(b, c);
  const double square = squared_length(normal);
  if (square > 0) {
    const double s = dot(normal, cross(point, c)) / square;
    const double r = dot(normal, cross(b, point)) / square;
    if (s >= 0 && r >= 0 && s + r <= 1) return {point, b * s + c * r};
  }
  ClosestPair best{point, on_segment(b, point)};
  for (const Vec3d& other : {on_segment(c, point), b + on_segment(c - b, point - b)}) {
    if (squared_length(other - point) < squared_length(best.second - point)) best.second = other;
  }
  return best;
}

/// Returns the closest points of two segments: from the origin to `end`, and from `other_start` to `other_start +
/// other_along`.
ClosestPair closest_of_segments(const Vec3d& end, const Vec3d& other_start, const Vec3d& other_along) {
  const double a = squared_length(end);
  const double b = dot(end, other_along);
  const double c = squared_length(other_along);
  const double d = dot(end, other_start);
  const double e = dot(other_along, other_start);
  const double determinant = a * c - b * b;
  if (determinant > 0) {
    const double s = (d * c - b * e) / determinant;
    const double r = (b * d - a * e) / determinant;
    if (s >= 0 && s <= 1 && r >= 0 && r <= 1) return {end * s, other_start + other_along * r};
  }
  // If the lines' closest points lie outside the segments, one of the closest points is an end of a segment.
  const Vec3d other_end = other_start + other_along;
  ClosestPair best{on_segment(end, other_start), other_start};
  for (const ClosestPair& pair : {ClosestPair{on_segment(end, other_end), other_end},
                                  ClosestPair{{}, other_start + on_segment(other_along, -other_start)},
                                  ClosestPair{end, other_start + on_segment(other_along, end - other_start)}}) {
    if (squared_length(pair.first - pair.second) < squared_length(best.first - best.second)) best = pair;
  }
  return best;
}

constexpr double unit_roundoff = 0x1p-53;

/// A polynomial, given by its Bernstein coefficients over [0, 1]. The values of the polynomial in [0, 1] lie between
/// the least and the largest coefficient.
template <std::size_t size>
using Bernstein = std::array<double, size>;

/// Returns the Bernstein coefficients over the part [low, high] of [0, 1].
Bernstein<3> part(const Bernstein<3>& c, double low, double high) {
  const auto mix = [](double a, double b, double t) { return (1 - t) * a + t * b; };
  const double low0 = mix(c[0], c[1], low);
  const double low1 = mix(c[1], c[2], low);
  const double high0 = mix(c[0], c[1], high);
  const double high1 = mix(c[1], c[2], high);
  return {mix(low0, low1, low), mix(low0, low1, high), mix(high0, high1, high)};
}

Bernstein<4> part(const Bernstein<4>& c, double low, double high) {
  const auto mix = [](double a, double b, double t) { return (1 - t) * a + t * b; };
  const double l0 = mix(c[0], c[1], low);
  const double l1 = mix(c[1], c[2], low);
  const double l2 = mix(c[2], c[3], low);
  const double h0 = mix(c[0], c[1], high);
  const double h1 = mix(c[1], c[2], high);
  const double h2 = mix(c[2], c[3], high);
  const double ll0 = mix(l0, l1, low);
  const double ll1 = mix(l1, l2, low);
  const double hh0 = mix(h0, h1, high);
  const double hh1 = mix(h1, h2, high);
  return {mix(ll0, ll1, low), mix(ll0, ll1, high), mix(hh0, hh1, low), mix(hh0, hh1, high)};
}

template <std::size_t size>
double least(const Bernstein<size>& c) {
  return *std::min_element(c.begin(), c.end());
}

template <std::size_t size>
double most(const Bernstein<size>& c) {
  return *std::max_element(c.begin(), c.end());
}

/// A vector that changes linearly from `start` to `end`.
struct MovingVector {
  Vec3d start;
  Vec3d end;

  [[nodiscard]] double magnitude() const {
    double most = 0;
    for (const Vec3d& v : {start, end}) most = std::max({most, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return most;
  }
};

MovingVector between(const FourMovingPoints& points, std::size_t from, std::size_t to) {
  return {points.start[to] - points.start[from], points.end[to] - points.end[from]};
}

/// Bernstein coefficients of a vector that is quadratic in time.
using QuadraticVector = std::array<Vec3d, 3>;

QuadraticVector product(const MovingVector& a, const MovingVector& b) {
  return {cross(a.start, b.start), (cross(a.start, b.end) + cross(a.end, b.start)) * 0.5, cross(a.end, b.end)};
}

Bernstein<3> along(const QuadraticVector& v, std::size_t axis) {
  return {v[0][axis], v[1][axis], v[2][axis]};
}

/// Two features, given by the vectors u, v and w between their points. Two edges meet if a + s * u = b + r * v; a
/// vertex a + w and a face meet if w = s * u + r * v. For edges, w = b - a. With n = u x v, s * n is w x v. For edges,
/// r * n is w x u; for a face, r * n is u x w.
class Filter {
 public:
  Filter(const FourMovingPoints& points, FeatureKinds kinds, double tolerance, double before)
      : points_(points),
        is_face_(kinds == FeatureKinds::vertex_face),
        tolerance_(tolerance),
        before_(before),
        u_(is_face_ ? between(points, 1, 2) : between(points, 0, 1)),
        v_(is_face_ ? between(points, 1, 3) : between(points, 2, 3)),
        w_(is_face_ ? between(points, 1, 0) : between(points, 0, 2)),
        u_most_(u_.magnitude()),
        v_most_(v_.magnitude()),
        w_most_(w_.magnitude()),
        in_range_(is_in_range(u_most_) && is_in_range(v_most_) && is_in_range(w_most_)) {
    if (!in_range_) return;
    normal_ = product(u_, v_);
    volume_ = {dot(normal_[0], w_.start), (dot(normal_[0], w_.end) + 2 * dot(normal_[1], w_.start)) / 3,
               (2 * dot(normal_[1], w_.end) + dot(normal_[2], w_.start)) / 3, dot(normal_[2], w_.end)};
    volume_error_ = volume_rounding * u_most_ * v_most_ * w_most_;
    normal_error_ = area_rounding * u_most_ * v_most_;
    weight_error_ = area_rounding * w_most_ * std::max(u_most_, v_most_);
  }

  [[nodiscard]] FilteredImpact meeting() {
    if (in_range_ && !may_be_zero(volume_, volume_error_)) return {FilteredImpact::Answer::never, 0};
    if (may_only_shift()) {
      const FeatureKinds kinds = is_face_ ? FeatureKinds::vertex_face : FeatureKinds::edge_edge;
      const FilteredImpact shifted = shifted_impact(points_, kinds, tolerance_);
      if (shifted.answer != FilteredImpact::Answer::unknown) return shifted;
    }
    if (!in_range_) return {};
    first_ = product(w_, v_);
    second_ = is_face_ ? product(u_, w_) : product(w_, u_);
    return first_by(most_looks_for_meeting, [&](const Interval& interval) { return look_at(interval); });
  }

  /// Returns the time at which the features come as close as a distance. The distance must be positive.
  [[nodiscard]] FilteredImpact approach(double distance) {
    const auto is_small = [](double magnitude) { return magnitude < 1e90; };
    if (!is_small(u_most_) || !is_small(v_most_) || !is_small(w_most_) || !is_in_range(distance)) return {};
    return first_by(most_looks_for_approach, [&](const Interval& interval) {
      if (are_apart_in(interval, distance)) return FilteredImpact::Answer::never;
      const bool is_short = interval.high - interval.low <= tolerance_;
      const bool is_close = is_short && (is_within(distance, interval.low) || is_within(distance, interval.high));
      return is_close ? FilteredImpact::Answer::meets : FilteredImpact::Answer::unknown;
    });
  }

 private:
  struct Interval {
    double low;
    double high;
  };

  /// Combines the answers for intervals of time into one answer for all times. Undecided intervals are halved.
  template <class LookAt>
  [[nodiscard]] FilteredImpact first_by(int most_looks, const LookAt& look_at) {
    left_.push_back({0, 1});
    for (int looks = 0; !left_.empty(); ++looks) {
      if (looks > most_looks) return {};
      const Interval interval = left_.pop_back();
      if (interval.low >= before_) break;  // so are the intervals that are left
      const FilteredImpact::Answer answer = look_at(interval);
      if (answer == FilteredImpact::Answer::never) continue;
      if (answer == FilteredImpact::Answer::meets) return {answer, grid_time(interval.low)};
      if (interval.high - interval.low < least_width) return {};
      const double cut = 0.5 * (interval.low + interval.high);
      left_.push_back({cut, interval.high});
      left_.push_back({interval.low, cut});
    }
    return {FilteredImpact::Answer::never, 0};
  }

  // Bounds on rounding errors, with a safety margin; proven in docs/theory/proximity.md.
  static constexpr double volume_rounding = 256 * unit_roundoff;
  static constexpr double area_rounding = 64 * unit_roundoff;
  static constexpr double height_rounding = 64 * unit_roundoff;
  // Limits on the number of intervals examined. The examination of more intervals would take longer than integer
  // arithmetic.
  static constexpr int most_looks_for_meeting = 96;
  static constexpr int most_looks_for_approach = 10000;
  static constexpr double least_width = 0x1p-44;

  /// Returns true if products of three numbers of this magnitude do not overflow, and underflow causes no larger errors
  /// than rounding.
  static bool is_in_range(double magnitude) { return magnitude > 1e-80 && magnitude < 1e90; }

  /// Returns false if one of the features certainly does more than translate.
  [[nodiscard]] bool may_only_shift() const { return u_.start == u_.end && v_.start == v_.end; }

  /// Returns the largest time on the grid of reported times that is not above `low`.
  [[nodiscard]] double grid_time(double low) const {
    const int depth = time_depth(tolerance_);
    return std::ldexp(std::floor(std::ldexp(low, depth)), -depth);
  }

  template <std::size_t size>
  static bool may_be_zero(const Bernstein<size>& c, double error) {
    return least(c) <= error && most(c) >= -error;
  }

  /// Returns `meets` if the features certainly meet in an interval and the interval is at most as long as the
  /// tolerance. Returns `never` if the features certainly do not meet in the interval.
  [[nodiscard]] FilteredImpact::Answer look_at(const Interval& interval) const {
    using Answer = FilteredImpact::Answer;
    const Bernstein<4> volume = part(volume_, interval.low, interval.high);
    if (!may_be_zero(volume, volume_error_)) return Answer::never;
    const bool crosses = std::abs(volume[0]) > volume_error_ && std::abs(volume[3]) > volume_error_ &&
                         (volume[0] > 0) != (volume[3] > 0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Bernstein<3> normal = part(along(normal_, axis), interval.low, interval.high);
      if (may_be_zero(normal, normal_error_)) continue;
      const double sign = normal[0] > 0 ? 1 : -1;
      bool is_inside = true;
      Bernstein<3> rest = normal;  // for a face (1 - s - r), for edges (1 - s) or (1 - r), times the normal
      for (const QuadraticVector* weight : {&first_, &second_}) {
        const Bernstein<3> c = part(along(*weight, axis), interval.low, interval.high);
        if (sign * (sign > 0 ? most(c) : least(c)) < -weight_error_) return Answer::never;
        is_inside = is_inside && sign * (sign > 0 ? least(c) : most(c)) > weight_error_;
        for (std::size_t k = 0; k < 3; ++k) rest[k] = (is_face_ ? rest[k] : normal[k]) - c[k];
        if (is_face_ && weight == &first_) continue;
        const double error = 2 * (normal_error_ + 2 * weight_error_);
        if (sign * (sign > 0 ? most(rest) : least(rest)) < -error) return Answer::never;
        is_inside = is_inside && sign * (sign > 0 ? least(rest) : most(rest)) > error;
      }
      if (is_inside && crosses && interval.high - interval.low <= tolerance_) return Answer::meets;
    }
    // If signs do not decide, there may be a gap between the features along the line through their closest points.
    constexpr double narrow = 0.25;
    constexpr double too_narrow = 0.03;  // a gap that was not found in a longer interval is too small
    const double width = interval.high - interval.low;
    return width <= narrow && width >= too_narrow && are_apart_in(interval, 0) ? Answer::never : Answer::unknown;
  }

  /// Returns true if the features are certainly further apart than a distance throughout an interval. The test uses the
  /// direction between their closest points at the middle of the interval. Heights along this direction are linear in
  /// time.
  [[nodiscard]] bool are_apart_in(const Interval& interval, double distance) const {
    const double middle = 0.5 * (interval.low + interval.high);
    const ClosestPair closest = closest_at(middle);
    const Vec3d way = closest.first - closest.second;
    const double size = std::abs(way.x) + std::abs(way.y) + std::abs(way.z);
    constexpr double least_size = 1e-100;  // squares of smaller numbers underflow
    if (size < least_size) return false;
    const double rounding = height_rounding * size * (u_most_ + v_most_ + w_most_);
    const double least = distance * length(way) * (1 + 8 * unit_roundoff) + rounding;
    for (const double t : {interval.low, interval.high}) {
      const double u = dot(way, at(u_, t));
      const double v = dot(way, at(v_, t));
      const double w = dot(way, at(w_, t));
      const double gap = is_face_ ? std::min({w, w - u, w - v}) : std::min(0.0, u) - std::max(w, w + v);
      if (!(gap > least)) return false;
    }
    return true;
  }

  /// Returns true if the features are certainly at most a distance apart at a given time.
  [[nodiscard]] bool is_within(double distance, double t) const {
    const ClosestPair closest = closest_at(t);
    const double rounding = height_rounding * (u_most_ + v_most_ + w_most_);
    return length(closest.first - closest.second) * (1 + 8 * unit_roundoff) + rounding < distance;
  }

  [[nodiscard]] ClosestPair closest_at(double t) const {
    return is_face_ ? closest_of_point_and_triangle(at(w_, t), at(u_, t), at(v_, t))
                    : closest_of_segments(at(u_, t), at(w_, t), at(v_, t));
  }

  static Vec3d at(const MovingVector& v, double t) { return v.start * (1 - t) + v.end * t; }

  const FourMovingPoints& points_;
  bool is_face_;
  double tolerance_;
  double before_;
  MovingVector u_, v_, w_;
  double u_most_, v_most_, w_most_;
  bool in_range_;
  QuadraticVector normal_;
  QuadraticVector first_;   ///< s times the normal
  QuadraticVector second_;  ///< r times the normal
  Bernstein<4> volume_{};
  double volume_error_ = 0;
  double normal_error_ = 0;
  double weight_error_ = 0;
  InlineList<Interval, 64> left_;
};

}  // namespace

int time_depth(double tolerance) {
  int exponent = 0;
  std::frexp(tolerance, &exponent);
  return 1 - exponent;
}

FilteredImpact filtered_impact(const FourMovingPoints& points, FeatureKinds kinds, const ImpactOptions& options,
                               double before) {
  Filter filter(points, kinds, options.tolerance, before);
  return options.min_separation > 0 ? filter.approach(options.min_separation) : filter.meeting();
}

}  // namespace blum::detail
