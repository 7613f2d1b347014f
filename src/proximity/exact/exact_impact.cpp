#include "proximity/exact/exact_impact.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "blum/proximity/impact.hpp"
#include "proximity/exact/polynomial.hpp"
#include "proximity/impact_filter.hpp"

namespace blum::detail {
namespace {

/// The linear function start + slope * t.
struct Linear {
  Integer start;
  Integer slope;
};

using MovingVector = std::array<Linear, 3>;

/// Positions over time, and a distance, scaled by one power of two so that all are integers.
struct IntegerPoints {
  std::array<MovingVector, 4> at;
  Integer distance;
};
[[nodiscard]] IntegerPoints integer_points(const FourMovingPoints& points, double distance = 0);

[[nodiscard]] MovingVector operator-(const MovingVector& a, const MovingVector& b);
[[nodiscard]] Polynomial operator*(const Linear& a, const Linear& b);

using PolynomialVector = std::array<Polynomial, 3>;
[[nodiscard]] Polynomial dot(const PolynomialVector& a, const PolynomialVector& b);
[[nodiscard]] Polynomial dot(const PolynomialVector& a, const MovingVector& b);

/// A finite double as mantissa * 2^exponent. The mantissa is odd or zero.
struct WholeDouble {
  std::int64_t mantissa;
  int exponent;
};

WholeDouble parts_of(double value) {
  if (value == 0) return {0, std::numeric_limits<int>::max()};
  int exponent = 0;
  constexpr int digits = std::numeric_limits<double>::digits;
  const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), digits));
  exponent -= digits;
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(mantissa));
  return {mantissa / (std::int64_t{1} << zeros), exponent + zeros};
}

IntegerPoints integer_points(const FourMovingPoints& points, double distance) {
  int least = parts_of(distance).exponent;
  for (const auto* ends : {&points.start, &points.end}) {
    for (const Vec3d& p : *ends) {
      for (const double x : {p.x, p.y, p.z}) least = std::min(least, parts_of(x).exponent);
    }
  }
  const auto integer = [&](double x) {
    const WholeDouble parts = parts_of(x);
    return parts.mantissa == 0 ? Integer(0) : Integer(parts.mantissa) << static_cast<unsigned>(parts.exponent - least);
  };
  IntegerPoints out;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Integer start = integer(points.start[k][axis]);
      out.at[k][axis] = {start, integer(points.end[k][axis]) - start};
    }
  }
  out.distance = integer(distance);
  return out;
}

MovingVector operator-(const MovingVector& a, const MovingVector& b) {
  const auto difference = [&](std::size_t axis) {
    return Linear{a[axis].start - b[axis].start, a[axis].slope - b[axis].slope};
  };
  return {difference(0), difference(1), difference(2)};
}

Polynomial operator*(const Linear& a, const Linear& b) {
  return {a.start * b.start, a.start * b.slope + a.slope * b.start, a.slope * b.slope};
}

/// Returns one component of a cross product.
Polynomial cross_component(const MovingVector& a, const MovingVector& b, std::size_t axis) {
  const std::size_t next = (axis + 1) % 3;
  const std::size_t last = (axis + 2) % 3;
  return a[next] * b[last] - a[last] * b[next];
}

Polynomial dot(const MovingVector& a, const MovingVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

PolynomialVector cross(const MovingVector& a, const MovingVector& b) {
  return {cross_component(a, b, 0), cross_component(a, b, 1), cross_component(a, b, 2)};
}

Polynomial dot(const PolynomialVector& a, const PolynomialVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Polynomial dot(const PolynomialVector& a, const MovingVector& b) {
  Polynomial sum;
  for (std::size_t axis = 0; axis < 3; ++axis) sum = sum + a[axis] * Polynomial{b[axis].start, b[axis].slope};
  return sum;
}

/// Conditions over time for two parts of features; a part is a vertex, the inside of an edge, or the inside of a face.
/// The parts are at most the distance apart if `excess` is not positive, no item of `inside` is negative, and `size` is
/// positive. `inside` expresses that the closest points lie on the parts.
struct Parts {
  Polynomial excess;
  std::vector<Polynomial> inside;
  Polynomial size;
};

class Approach {
 public:
  explicit Approach(const IntegerPoints& points)
      : points_(points), square_{points.distance * points.distance}, one_{Integer(1)} {}

  void add_vertices(std::size_t a, std::size_t b) {
    const MovingVector between = vector(a, b);
    parts_.push_back({dot(between, between) - square_, {}, one_});
  }
  /// Adds the pair of a vertex and the inside of an edge. Arguments are indices of points.
  void add_vertex_and_edge(std::size_t point, std::size_t from, std::size_t to) {
    const MovingVector edge = vector(from, to);
    const MovingVector way = vector(from, point);
    const Polynomial size = dot(edge, edge);
    const Polynomial along = dot(edge, way);
    const PolynomialVector area = cross(edge, way);
    parts_.push_back({dot(area, area) - square_ * size, {along, size - along}, size});
  }
  void add_vertex_and_face() { add_insides(vector(1, 2), vector(1, 3), vector(1, 0), true); }
  void add_edge_and_edge() { add_insides(vector(0, 1), vector(2, 3), vector(0, 2), false); }

  /// Returns the first time at which the distance of two parts is at most the limit, `points_.distance`. The first time
  /// is the start, or a time at which a distance equals the limit. If a distance equals the limit at all times, the
  /// first time is that at which the closest points first lie on the parts.
  [[nodiscard]] std::optional<double> first(double tolerance) const {
    const RealRoots start(Polynomial{0, 1});
    const auto holds_at_start = [&](const Parts& parts) { return holds(parts, start, start.all().front()); };
    if (std::any_of(parts_.begin(), parts_.end(), holds_at_start)) return 0.0;
    std::optional<double> best;
    for (const Parts& parts : parts_) {
      if (!parts.excess.is_zero()) {
        look_at_roots_of(parts.excess, parts, tolerance, best);
        continue;
      }
      for (const Polynomial& one : parts.inside) look_at_roots_of(one, parts, tolerance, best);
      look_at_roots_of(parts.size, parts, tolerance, best);
    }
    return best;
  }

 private:
  [[nodiscard]] MovingVector vector(std::size_t from, std::size_t to) const {
    return points_.at[to] - points_.at[from];
  }

  /// Adds the insides of the edges a + s u and b + r v, with w = b - a. If `is_face`, adds the inside of the face a + s
  /// u + r v and the vertex a + w instead.
  void add_insides(const MovingVector& u, const MovingVector& v, const MovingVector& w, bool is_face) {
    const PolynomialVector normal = cross(u, v);
    const Polynomial size = dot(normal, normal);
    const Polynomial volume = dot(normal, w);
    const Polynomial s = dot(normal, cross(w, v));
    const Polynomial r = dot(normal, is_face ? cross(u, w) : cross(w, u));
    std::vector<Polynomial> inside{s, r};
    if (is_face) {
      inside.push_back(size - s - r);
    } else {
      inside.insert(inside.end(), {size - s, size - r});
    }
    parts_.push_back({volume * volume - square_ * size, std::move(inside), size});
  }

  [[nodiscard]] static bool holds(const Parts& parts, const RealRoots& roots, const RealRoot& root) {
    return roots.sign_at(root, parts.excess) <= 0 && roots.sign_at(root, parts.size) > 0 &&
           std::all_of(parts.inside.begin(), parts.inside.end(),
                       [&](const Polynomial& one) { return roots.sign_at(root, one) >= 0; });
  }

  static void look_at_roots_of(const Polynomial& polynomial, const Parts& parts, double tolerance,
                               std::optional<double>& best) {
    if (polynomial.degree() <= 0) return;
    const RealRoots roots(polynomial);
    const auto depth = static_cast<unsigned>(time_depth(tolerance));
    for (const RealRoot& isolated : roots.all()) {
      const RealRoot root = roots.refined(isolated, depth);
      if (best && root.rounded_down(depth) >= *best) return;
      if (!holds(parts, roots, root)) continue;
      best = root.rounded_down(depth);
      return;
    }
  }

  const IntegerPoints& points_;
  Polynomial square_;
  Polynomial one_;
  std::vector<Parts> parts_;
};

/// Two features: a vertex and a face, or two edges. Two vectors span the plane of the face, or the plane parallel to
/// both edges. Polynomials are computed when first needed, because most of them never are.
class Features {
 public:
  /// A point that may lie on a segment; both are given by indices of points.
  struct Touch {
    std::size_t point;
    std::size_t from;
    std::size_t to;
  };

  static Features vertex_and_face(const FourMovingPoints& points) {
    return {points, {1, 2}, {1, 3}, {1, 0}, {{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}}}, 3};
  }
  static Features edge_and_edge(const FourMovingPoints& points) {
    return {points, {0, 1}, {2, 3}, {0, 2}, {{{2, 0, 1}, {3, 0, 1}, {0, 2, 3}, {1, 2, 3}}}, 4};
  }

  /// Returns a polynomial that is zero at times at which all four points lie in one plane.
  [[nodiscard]] Polynomial volume() const {
    const MovingVector w = vector(between_);
    Polynomial sum;
    for (std::size_t axis = 0; axis < 3; ++axis) sum = sum + normal(axis) * Polynomial{w[axis].start, w[axis].slope};
    return sum;
  }
  /// Returns one component of a vector: the cross product of two edge vectors of the face, or of both edges. The vector
  /// is zero if the edges do not span a plane.
  [[nodiscard]] const Polynomial& normal(std::size_t axis) const {
    return once(normals_[axis], [&] { return cross_component(u_, v_, axis); });
  }
  /// Returns one component of a vector that is zero at times at which the three points of a touch lie on a line.
  [[nodiscard]] const Polynomial& area(std::size_t touch, std::size_t axis) const {
    const auto [point, from, to] = touches_[touch];
    return once(areas_[touch][axis], [&] { return cross_component(vector({from, to}), vector({from, point}), axis); });
  }
  /// Returns a polynomial that is positive if the point of a touch lies on the line of its segment beyond its ends. The
  /// polynomial is zero or negative if the point lies on the segment.
  [[nodiscard]] const Polynomial& beyond(std::size_t touch) const {
    const auto [point, from, to] = touches_[touch];
    return once(beyond_[touch], [&] { return dot(vector({from, point}), vector({to, point})); });
  }
  /// Returns the number of points that may lie on segments of the other feature. If no plane is spanned, features meet
  /// if and only if one of these points lies on its segment.
  [[nodiscard]] std::size_t touches() const { return touch_count_; }

  /// Returns true if the features meet at a root: at a time at which all four points lie in one plane.
  [[nodiscard]] bool meet_at(const RealRoots& roots, const RealRoot& root) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (roots.sign_at(root, normal(axis)) != 0) return overlap_along(axis, roots, root);
    }
    for (std::size_t touch = 0; touch < touch_count_; ++touch) {
      if (is_on_line(touch, roots, root) && roots.sign_at(root, beyond(touch)) <= 0) return true;
    }
    return false;
  }

 private:
  using Ends = std::array<std::size_t, 2>;

  Features(const FourMovingPoints& points, Ends first, Ends second, Ends between, std::array<Touch, 4> touches,
           std::size_t touch_count)
      : points_(integer_points(points).at),
        u_(vector(first)),
        v_(vector(second)),
        between_(between),
        touches_(touches),
        touch_count_(touch_count) {}

  template <class Make>
  static const Polynomial& once(std::optional<Polynomial>& kept, const Make& make) {
    if (!kept) kept.emplace(make());
    return *kept;
  }

  [[nodiscard]] MovingVector vector(Ends ends) const { return points_[ends[1]] - points_[ends[0]]; }

  [[nodiscard]] bool is_on_line(std::size_t touch, const RealRoots& roots, const RealRoot& root) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (roots.sign_at(root, area(touch, axis)) != 0) return false;
    }
    return true;
  }

  /// Returns true if the features meet in the projection along an axis that is not parallel to their plane.
  [[nodiscard]] bool overlap_along(std::size_t axis, const RealRoots& roots, const RealRoot& root) const {
    const auto side = [&](std::size_t k) { return roots.sign_at(root, area(k, axis)); };
    const int first = side(0);
    const int second = side(1);
    const bool is_face = touch_count_ == 3;
    if (!is_face) return first * second <= 0 && side(2) * side(3) <= 0;
    if (first * second < 0) return false;
    const int third = side(2);
    return first * third >= 0 && second * third >= 0;
  }

  std::array<MovingVector, 4> points_;
  MovingVector u_, v_;
  Ends between_;  ///< a point of the first feature and a point of the second
  std::array<Touch, 4> touches_;
  std::size_t touch_count_;
  mutable std::array<std::optional<Polynomial>, 3> normals_;
  mutable std::array<std::array<std::optional<Polynomial>, 3>, 4> areas_;
  mutable std::array<std::optional<Polynomial>, 4> beyond_;
};

/// Looks for the first root of a polynomial at which the features meet. Only roots before `best` are considered.
void look_at_roots_of(const Polynomial& polynomial, const Features& features, double tolerance,
                      std::optional<double>& best) {
  if (polynomial.degree() <= 0) return;
  const RealRoots roots(polynomial);
  const auto depth = static_cast<unsigned>(time_depth(tolerance));
  for (const RealRoot& isolated : roots.all()) {
    // In a narrow interval around the root, signs of other polynomials are decided fast.
    const RealRoot root = roots.refined(isolated, depth);
    const double time = root.rounded_down(depth);
    if (best && time >= *best) return;
    if (!features.meet_at(roots, root)) continue;
    best = time;
    return;
  }
}

/// Calls visit(polynomial) for polynomials of features whose points lie in one plane at all times. The first contact is
/// the start, or a root of one of them.
template <class Visit>
void for_each_decisive(const Features& features, const Visit& visit) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (features.normal(axis).is_zero()) continue;
    // Along this axis, areas alone decide, except at roots of this component.
    visit(features.normal(axis));
    for (std::size_t touch = 0; touch < features.touches(); ++touch) visit(features.area(touch, axis));
    return;
  }
  // A point lies on a segment at a root of any component that is not zero at all times.
  for (std::size_t touch = 0; touch < features.touches(); ++touch) {
    std::size_t axis = 0;
    while (axis < 3 && features.area(touch, axis).is_zero()) ++axis;
    visit(axis < 3 ? features.area(touch, axis) : features.beyond(touch));
  }
}

/// Returns the first time at which two features meet whose points lie in one plane at all times.
std::optional<double> first_in_plane(const Features& features, double tolerance) {
  std::optional<double> best;
  const RealRoots start(Polynomial{0, 1});
  if (features.meet_at(start, start.all().front())) return 0.0;
  for_each_decisive(features,
                    [&](const Polynomial& polynomial) { look_at_roots_of(polynomial, features, tolerance, best); });
  return best;
}

std::optional<double> first_meeting(const Features& features, double tolerance) {
  const Polynomial volume = features.volume();
  if (volume.is_zero()) return first_in_plane(features, tolerance);
  std::optional<double> best;
  look_at_roots_of(volume, features, tolerance, best);
  return best;
}

}  // namespace

std::optional<double> exact_vertex_face_approach(const FourMovingPoints& points, double distance, double tolerance) {
  const IntegerPoints integers = integer_points(points, distance);
  Approach approach(integers);
  for (std::size_t k = 1; k < 4; ++k) {
    approach.add_vertices(0, k);
    approach.add_vertex_and_edge(0, k, k % 3 + 1);
  }
  approach.add_vertex_and_face();
  return approach.first(tolerance);
}

std::optional<double> exact_edge_edge_approach(const FourMovingPoints& points, double distance, double tolerance) {
  const IntegerPoints integers = integer_points(points, distance);
  Approach approach(integers);
  for (const std::size_t a : {0U, 1U}) {
    for (const std::size_t b : {2U, 3U}) approach.add_vertices(a, b);
    approach.add_vertex_and_edge(a, 2, 3);
    approach.add_vertex_and_edge(a + 2, 0, 1);
  }
  approach.add_edge_and_edge();
  return approach.first(tolerance);
}

std::optional<double> exact_vertex_face_impact(const FourMovingPoints& points, double tolerance) {
  return first_meeting(Features::vertex_and_face(points), tolerance);
}

std::optional<double> exact_edge_edge_impact(const FourMovingPoints& points, double tolerance) {
  return first_meeting(Features::edge_and_edge(points), tolerance);
}

}  // namespace blum::detail
