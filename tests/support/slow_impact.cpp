#include "support/slow_impact.hpp"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <functional>
#include <utility>
#include <vector>

namespace blum::test {
namespace {

using Number = boost::multiprecision::cpp_rational;

/// Coefficients in ascending order of degree. The last one is not zero.
using Polynomial = std::vector<Number>;
using Vector = std::array<Polynomial, 3>;

Polynomial trimmed(Polynomial p) {
  while (!p.empty() && p.back() == 0) p.pop_back();
  return p;
}

Polynomial sum(const Polynomial& a, const Polynomial& b, int sign) {
  Polynomial out(std::max(a.size(), b.size()));
  for (std::size_t k = 0; k < a.size(); ++k) out[k] += a[k];
  for (std::size_t k = 0; k < b.size(); ++k) out[k] += sign * b[k];
  return trimmed(std::move(out));
}

Polynomial product(const Polynomial& a, const Polynomial& b) {
  if (a.empty() || b.empty()) return {};
  Polynomial out(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < b.size(); ++k) out[i + k] += a[i] * b[k];
  }
  return out;
}

struct Division {
  Polynomial quotient;
  Polynomial rest;
};

Division divided(Polynomial a, const Polynomial& b) {
  Division out;
  if (a.size() >= b.size()) out.quotient.resize(a.size() - b.size() + 1);
  while (a.size() >= b.size()) {
    const Number factor = a.back() / b.back();
    const std::size_t shift = a.size() - b.size();
    out.quotient[shift] = factor;
    for (std::size_t k = 0; k < b.size(); ++k) a[k + shift] -= factor * b[k];
    a.pop_back();
    a = trimmed(std::move(a));
  }
  out.rest = std::move(a);
  return out;
}

Polynomial scaled_to_one(Polynomial p) {
  const Number leading = p.back();
  for (Number& c : p) c /= leading;
  return p;
}

Polynomial greatest_common_divisor(Polynomial a, Polynomial b) {
  while (!b.empty()) {
    Polynomial rest = divided(a, b).rest;
    a = std::move(b);
    b = std::move(rest);
    if (!b.empty()) b = scaled_to_one(std::move(b));
  }
  return scaled_to_one(std::move(a));
}

Polynomial derivative(const Polynomial& p) {
  Polynomial out;
  for (std::size_t k = 1; k < p.size(); ++k) out.push_back(p[k] * static_cast<int>(k));
  return out;
}

Number value(const Polynomial& p, const Number& t) {
  Number out = 0;
  for (std::size_t k = p.size(); k-- > 0;) out = out * t + p[k];
  return out;
}

int sign(const Number& x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

/// Counts the roots of a polynomial without multiple roots.
class Roots {
 public:
  explicit Roots(const Polynomial& p) : sequence_{p, derivative(p)} {
    while (!sequence_.back().empty()) {
      Polynomial next = divided(sequence_[sequence_.size() - 2], sequence_.back()).rest;
      const Number size = next.empty() ? Number(1) : Number(abs(next.back()));
      for (Number& c : next) c /= -size;
      sequence_.push_back(std::move(next));
    }
  }
  /// The number of roots in (low, high].
  [[nodiscard]] int in(const Number& low, const Number& high) const { return variations(low) - variations(high); }
  [[nodiscard]] bool are_at(const Number& t) const { return value(sequence_[0], t) == 0; }
  [[nodiscard]] const Polynomial& polynomial() const { return sequence_[0]; }

 private:
  [[nodiscard]] int variations(const Number& t) const {
    int changes = 0;
    int last = 0;
    for (const Polynomial& one : sequence_) {
      const int here = sign(value(one, t));
      if (here != 0 && last != 0 && here != last) ++changes;
      if (here != 0) last = here;
    }
    return changes;
  }

  std::vector<Polynomial> sequence_;
};

Polynomial square_free(const Polynomial& p) {
  return p.size() < 2 ? p : divided(p, greatest_common_divisor(p, derivative(p))).quotient;
}

/// A root of a polynomial in [0, 1]: the only one in (low, high], or `high` itself if both are equal.
class Time {
 public:
  Time(Roots roots, Number low, Number high) : roots_(std::move(roots)), low_(std::move(low)), high_(std::move(high)) {}

  /// The sign of another polynomial at this root. Narrows the interval as far as needed.
  [[nodiscard]] int sign_of(const Polynomial& other) {
    if (other.empty()) return 0;
    if (low_ == high_ || other.size() == 1) return sign(value(other, high_));
    const Polynomial common = greatest_common_divisor(roots_.polynomial(), other);
    if (common.size() > 1 && Roots(common).in(low_, high_) > 0) return 0;
    const Roots others(square_free(other));
    while (others.in(low_, high_) > 0) halve();
    return sign(value(other, high_));
  }

  [[nodiscard]] ContactTime narrowed() {
    const Number width = Number(1) / (boost::multiprecision::cpp_int(1) << 60);
    while (high_ - low_ > width) halve();
    return {low_.convert_to<double>(), high_.convert_to<double>()};
  }

 private:
  void halve() {
    const Number middle = (low_ + high_) / 2;
    (roots_.in(low_, middle) > 0 ? high_ : low_) = middle;
    if (roots_.are_at(high_)) low_ = high_;
  }

  Roots roots_;
  Number low_;
  Number high_;
};

void add_roots(const Roots& roots, const Number& low, const Number& high, std::vector<Time>& times) {
  const int count = roots.in(low, high);
  if (count == 1) times.emplace_back(roots, roots.are_at(high) ? high : low, high);
  if (count < 2) return;
  const Number middle = (low + high) / 2;
  add_roots(roots, low, middle, times);
  add_roots(roots, middle, high, times);
}

std::array<Vector, 4> positions(const FourMovingPoints& points) {
  std::array<Vector, 4> out;
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Number start = points.start[k][axis];
      out[k][axis] = trimmed({start, Number(points.end[k][axis]) - start});
    }
  }
  return out;
}

Vector operator-(const Vector& a, const Vector& b) {
  return {sum(a[0], b[0], -1), sum(a[1], b[1], -1), sum(a[2], b[2], -1)};
}

Vector cross(const Vector& a, const Vector& b) {
  const auto minor = [&](std::size_t i, std::size_t k) { return sum(product(a[i], b[k]), product(a[k], b[i]), -1); };
  return {minor(1, 2), minor(2, 0), minor(0, 1)};
}

Polynomial dot(const Vector& a, const Vector& b) {
  return sum(sum(product(a[0], b[0]), product(a[1], b[1]), 1), product(a[2], b[2]), 1);
}

/// Polynomials that decide if a point is on a segment.
struct OnSegment {
  OnSegment(const Vector& p, const Vector& a, const Vector& b) : area(cross(b - a, p - a)), beyond(dot(p - a, p - b)) {}
  Vector area;
  Polynomial beyond;
};

/// Features meet if all of `inside` are at least zero, `volume` is zero, and `normal` is not zero. They also meet if a
/// point is on a segment.
std::optional<ContactTime> first_contact(const Polynomial& volume, const Vector& normal,
                                         const std::vector<Polynomial>& inside, const std::vector<OnSegment>& touches) {
  std::vector<Polynomial> all{volume, dot(normal, normal)};
  all.insert(all.end(), inside.begin(), inside.end());
  for (const OnSegment& touch : touches) {
    all.insert(all.end(), touch.area.begin(), touch.area.end());
    all.push_back(touch.beyond);
  }
  std::vector<Time> times{Time(Roots({0, 1}), 0, 0)};
  for (const Polynomial& one : all) {
    if (one.size() > 1) add_roots(Roots(square_free(one)), 0, 1, times);
  }
  std::optional<ContactTime> first;
  for (Time& time : times) {
    const auto sign = [&](const Polynomial& p) { return time.sign_of(p); };
    const auto is_zero = [&](const Polynomial& p) { return sign(p) == 0; };
    const bool meets = is_zero(volume) && sign(dot(normal, normal)) > 0 &&
                       std::all_of(inside.begin(), inside.end(), [&](const Polynomial& p) { return sign(p) >= 0; });
    const bool touch = std::any_of(touches.begin(), touches.end(), [&](const OnSegment& one) {
      return std::all_of(one.area.begin(), one.area.end(), is_zero) && sign(one.beyond) <= 0;
    });
    if (!meets && !touch) continue;
    const ContactTime found = time.narrowed();
    if (!first || found.high < first->high) first = found;
  }
  return first;
}

/// Two parts of features. They are close if `excess` is not positive, all of `inside` are at least zero and `size` is
/// positive.
struct CloseParts {
  Polynomial excess;
  std::vector<Polynomial> inside;
  Polynomial size;
};

/// Checks at all roots of all polynomials if any parts are close.
std::optional<ContactTime> first_approach(const std::vector<CloseParts>& all) {
  std::vector<Time> times{Time(Roots({0, 1}), 0, 0)};
  const auto add = [&](const Polynomial& one) {
    if (one.size() > 1) add_roots(Roots(square_free(one)), 0, 1, times);
  };
  for (const CloseParts& parts : all) {
    add(parts.excess);
    add(parts.size);
    for (const Polynomial& one : parts.inside) add(one);
  }
  std::optional<ContactTime> first;
  for (Time& time : times) {
    const bool is_close = std::any_of(all.begin(), all.end(), [&](const CloseParts& parts) {
      return time.sign_of(parts.excess) <= 0 && time.sign_of(parts.size) > 0 &&
             std::all_of(parts.inside.begin(), parts.inside.end(),
                         [&](const Polynomial& one) { return time.sign_of(one) >= 0; });
    });
    if (!is_close) continue;
    const ContactTime found = time.narrowed();
    if (!first || found.high < first->high) first = found;
  }
  return first;
}

Polynomial scaled(Polynomial p, const Number& by) {
  for (Number& c : p) c *= by;
  return trimmed(std::move(p));
}

CloseParts two_points(const Vector& a, const Vector& b, const Number& square) {
  return {sum(dot(b - a, b - a), {square}, -1), {}, {Number(1)}};
}

CloseParts point_and_segment(const Vector& p, const Vector& a, const Vector& b, const Number& square) {
  const Polynomial size = dot(b - a, b - a);
  const Vector area = cross(b - a, p - a);
  return {sum(dot(area, area), scaled(size, square), -1), {dot(b - a, p - a), dot(a - b, p - b)}, size};
}

/// @param inside  at least zero if the closest points of plane and point, or of two lines, lie on the features.
CloseParts of_plane(const Vector& normal, const Vector& between, std::vector<Polynomial> inside, const Number& square) {
  const Polynomial volume = dot(normal, between);
  const Polynomial size = dot(normal, normal);
  return {sum(product(volume, volume), scaled(size, square), -1), std::move(inside), size};
}

}  // namespace

std::optional<ContactTime> slow_vertex_face_approach(const FourMovingPoints& points, double distance) {
  const Number square = Number(distance) * Number(distance);
  const auto [p, a, b, c] = positions(points);
  const Vector normal = cross(b - a, c - a);
  std::vector<CloseParts> all{of_plane(
      normal, p - a,
      {dot(normal, cross(b - a, p - a)), dot(normal, cross(c - b, p - b)), dot(normal, cross(a - c, p - c))}, square)};
  for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    all.push_back(point_and_segment(p, from, to, square));
    all.push_back(two_points(p, from, square));
  }
  return first_approach(all);
}

std::optional<ContactTime> slow_edge_edge_approach(const FourMovingPoints& points, double distance) {
  const Number square = Number(distance) * Number(distance);
  const auto [a, b, c, d] = positions(points);
  const Vector normal = cross(b - a, d - c);
  const Polynomial whole = dot(normal, normal);
  const Polynomial s = dot(normal, cross(c - a, d - c));
  const Polynomial r = dot(normal, cross(c - a, b - a));
  std::vector<CloseParts> all{of_plane(normal, c - a, {s, sum(whole, s, -1), r, sum(whole, r, -1)}, square)};
  for (const Vector* end : {&c, &d}) {
    all.push_back(point_and_segment(*end, a, b, square));
    all.push_back(two_points(*end, a, square));
    all.push_back(two_points(*end, b, square));
  }
  for (const Vector* end : {&a, &b}) all.push_back(point_and_segment(*end, c, d, square));
  return first_approach(all);
}

std::optional<ContactTime> slow_vertex_face_impact(const FourMovingPoints& points) {
  const auto [p, a, b, c] = positions(points);
  const Vector normal = cross(b - a, c - a);
  return first_contact(
      dot(normal, p - a), normal,
      {dot(normal, cross(b - a, p - a)), dot(normal, cross(c - b, p - b)), dot(normal, cross(a - c, p - c))},
      {{p, a, b}, {p, b, c}, {p, c, a}});
}

std::optional<ContactTime> slow_edge_edge_impact(const FourMovingPoints& points) {
  const auto [a, b, c, d] = positions(points);
  const Vector normal = cross(b - a, d - c);
  // a + s (b - a) = c + r (d - c), with s and r times the squared length of the normal.
  const Polynomial whole = dot(normal, normal);
  const Polynomial s = dot(normal, cross(c - a, d - c));
  const Polynomial r = dot(normal, cross(c - a, b - a));
  return first_contact(dot(normal, c - a), normal, {s, sum(whole, s, -1), r, sum(whole, r, -1)},
                       {{c, a, b}, {d, a, b}, {a, c, d}, {b, c, d}});
}

}  // namespace blum::test
