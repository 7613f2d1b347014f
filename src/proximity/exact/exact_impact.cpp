#include "proximity/exact/exact_impact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "proximity/exact/real_roots.hpp"

namespace blum::detail {
namespace {

/// start + slope * t.
struct Linear {
  Integer start;
  Integer slope;
};

using Vector = std::array<Linear, 3>;

/// A finite double as mantissa * 2^exponent, the mantissa odd or zero.
struct Parts {
  std::int64_t mantissa;
  int exponent;
};

Parts parts_of(double value) {
  if (value == 0) return {0, std::numeric_limits<int>::max()};
  int exponent = 0;
  constexpr int digits = std::numeric_limits<double>::digits;
  auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), digits));
  exponent -= digits;
  while (mantissa % 2 == 0) {
    mantissa /= 2;
    ++exponent;
  }
  return {mantissa, exponent};
}

/// The positions over time, scaled by one power of two such that all coordinates are integers.
std::array<Vector, 4> positions(const FourMovingPoints& points) {
  int least = std::numeric_limits<int>::max();
  for (const auto* ends : {&points.start, &points.end}) {
    for (const Vec3d& p : *ends) {
      for (const double x : {p.x, p.y, p.z}) least = std::min(least, parts_of(x).exponent);
    }
  }
  const auto integer = [&](double x) {
    const Parts parts = parts_of(x);
    return parts.mantissa == 0 ? Integer(0) : Integer(parts.mantissa) << static_cast<unsigned>(parts.exponent - least);
  };
  std::array<Vector, 4> out;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Integer start = integer(points.start[k][axis]);
      out[k][axis] = {start, integer(points.end[k][axis]) - start};
    }
  }
  return out;
}

Vector operator-(const Vector& a, const Vector& b) {
  Vector out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    out[axis] = {a[axis].start - b[axis].start, a[axis].slope - b[axis].slope};
  }
  return out;
}

Polynomial operator*(const Linear& a, const Linear& b) {
  return {a.start * b.start, a.start * b.slope + a.slope * b.start, a.slope * b.slope};
}

/// One component of a cross product.
Polynomial component(const Vector& a, const Vector& b, std::size_t axis) {
  const std::size_t next = (axis + 1) % 3;
  const std::size_t last = (axis + 2) % 3;
  return a[next] * b[last] - a[last] * b[next];
}

Polynomial dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Two features, in a plane of which two vectors are along both.
class Features {
 public:
  /// A point that may lie on a segment, by their numbers.
  struct Touch {
    std::size_t point;
    std::size_t from;
    std::size_t to;
  };

  static Features vertex_and_face(const FourMovingPoints& points) {
    return {positions(points), {1, 2}, {1, 3}, {1, 0}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}}};
  }
  static Features edge_and_edge(const FourMovingPoints& points) {
    return {positions(points), {0, 1}, {2, 3}, {0, 2}, {{2, 0, 1}, {3, 0, 1}, {0, 2, 3}, {1, 2, 3}}};
  }

  /// Zero where all points lie in one plane.
  [[nodiscard]] Polynomial volume() const {
    const Vector between = vector(between_[0], between_[1]);
    Polynomial sum;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sum = sum + normal(axis) * Polynomial{between[axis].start, between[axis].slope};
    }
    return sum;
  }
  /// Zero along all axes where the points of a face, or directions of edges, have no plane of their own.
  [[nodiscard]] Polynomial normal(std::size_t axis) const {
    return component(vector(first_[0], first_[1]), vector(second_[0], second_[1]), axis);
  }
  /// Zero along all axes where the three points lie on a line.
  [[nodiscard]] Polynomial area(const Touch& touch, std::size_t axis) const {
    return component(vector(touch.from, touch.to), vector(touch.from, touch.point), axis);
  }
  /// On that line: positive beyond the ends of the segment.
  [[nodiscard]] Polynomial beyond(const Touch& touch) const {
    return dot(vector(touch.from, touch.point), vector(touch.to, touch.point));
  }
  /// With no plane, features meet where one of these points lies on its segment.
  [[nodiscard]] const std::vector<Touch>& touches() const { return touches_; }

  /// Whether they meet at a root, where their points lie in one plane.
  [[nodiscard]] bool meet_at(const RealRoots& roots, const RealRoot& root) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (roots.sign_at(root, normal(axis)) != 0) return overlap_along(axis, roots, root);
    }
    return std::any_of(touches_.begin(), touches_.end(), [&](const Touch& touch) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (roots.sign_at(root, area(touch, axis)) != 0) return false;
      }
      return roots.sign_at(root, beyond(touch)) <= 0;
    });
  }

 private:
  using Ends = std::array<std::size_t, 2>;

  Features(const std::array<Vector, 4>& points, Ends first, Ends second, Ends between, std::vector<Touch> touches)
      : points_(points), first_(first), second_(second), between_(between), touches_(std::move(touches)) {}

  [[nodiscard]] Vector vector(std::size_t from, std::size_t to) const { return points_[to] - points_[from]; }

  /// Whether they meet, seen along an axis that their plane does not hold.
  [[nodiscard]] bool overlap_along(std::size_t axis, const RealRoots& roots, const RealRoot& root) const {
    const auto side = [&](std::size_t k) { return roots.sign_at(root, area(touches_[k], axis)); };
    const int first = side(0);
    const int second = side(1);
    const bool is_face = touches_.size() == 3;
    if (!is_face) return first * second <= 0 && side(2) * side(3) <= 0;
    if (first * second < 0) return false;
    const int third = side(2);
    return first * third >= 0 && second * third >= 0;
  }

  std::array<Vector, 4> points_;
  Ends first_;
  Ends second_;
  Ends between_;  ///< a point of the first and one of the second
  std::vector<Touch> touches_;
};

unsigned depth_of(double tolerance) {
  int exponent = 0;
  std::frexp(tolerance, &exponent);
  return static_cast<unsigned>(std::max(1 - exponent, 0)) + 1;
}

/// The first root at which the features meet.
std::optional<double> first_at_roots_of(const Polynomial& polynomial, const Features& features, double tolerance) {
  const RealRoots roots(polynomial);
  for (const RealRoot& isolated : roots.all()) {
    // Narrow, signs next to it are soon told.
    const RealRoot root = roots.refined(isolated, depth_of(tolerance));
    if (features.meet_at(roots, root)) return root.lower_bound();
  }
  return std::nullopt;
}

/// Of points that never leave their common plane: the features meet for the first time at the start or where one of the
/// signs that tell it changes.
std::optional<double> first_in_plane(const Features& features, double tolerance) {
  std::optional<double> first = first_at_roots_of(Polynomial{0, 1}, features, tolerance);
  const auto look_at = [&](const Polynomial& polynomial) {
    if (polynomial.is_zero() || first == 0.0) return;
    const std::optional<double> next = first_at_roots_of(polynomial, features, tolerance);
    if (next && !(first && *first <= *next)) first = next;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    look_at(features.normal(axis));
    for (const Features::Touch& touch : features.touches()) look_at(features.area(touch, axis));
  }
  for (const Features::Touch& touch : features.touches()) look_at(features.beyond(touch));
  return first;
}

std::optional<double> first_meeting(const Features& features, double tolerance) {
  const Polynomial volume = features.volume();
  return volume.is_zero() ? first_in_plane(features, tolerance) : first_at_roots_of(volume, features, tolerance);
}

}  // namespace

std::optional<double> exact_vertex_face_impact(const FourMovingPoints& points, double tolerance) {
  return first_meeting(Features::vertex_and_face(points), tolerance);
}

std::optional<double> exact_edge_edge_impact(const FourMovingPoints& points, double tolerance) {
  return first_meeting(Features::edge_and_edge(points), tolerance);
}

}  // namespace blum::detail
