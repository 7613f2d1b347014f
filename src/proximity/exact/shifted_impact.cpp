#include "proximity/exact/shifted_impact.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <type_traits>

#include "exact/integer.hpp"

namespace blum::detail {
namespace {

using Answer = FilteredImpact::Answer;

/// Coordinates as integers: multiples of one power of two along each axis. Different scales along axes do not change
/// when features meet.
struct LatticePoints {
  std::array<std::array<std::int64_t, 3>, 4> start;
  std::array<std::array<std::int64_t, 3>, 4> end;
  int bits = 0;  ///< magnitudes are less than 2^bits
};

constexpr int most_bits = 62;  ///< so that differences of coordinates fit into 64 bits

constexpr int mantissa_bits = 52;
constexpr std::uint64_t hidden_bit = std::uint64_t{1} << mantissa_bits;

int exponent_of(double x) {
  constexpr int mask = 0x7ff;
  return static_cast<int>(std::bit_cast<std::uint64_t>(x) >> mantissa_bits) & mask;
}

std::uint64_t mantissa_of(double x) {
  return (std::bit_cast<std::uint64_t>(x) & (hidden_bit - 1)) | hidden_bit;
}

/// Exponents of the lowest and the highest bit of coordinates along an axis.
struct BitRange {
  int low = std::numeric_limits<int>::max();
  int high = 0;
  bool is_normal = true;  ///< false if a number is too small to have a hidden bit

  void add(double x) {
    if (x == 0) return;
    const int exponent = exponent_of(x);
    is_normal = is_normal && exponent > 0;
    low = std::min(low, exponent + std::countr_zero(mantissa_of(x)));
    high = std::max(high, exponent + mantissa_bits + 1);
  }
  [[nodiscard]] int bits() const { return high == 0 ? 0 : high - low; }
};

/// Returns x divided by the place value of a bit.
std::int64_t integer(double x, int low) {
  if (x == 0) return 0;
  const int shift = exponent_of(x) - low;
  const std::uint64_t size = shift < 0 ? mantissa_of(x) >> -shift : mantissa_of(x) << shift;
  return x < 0 ? -static_cast<std::int64_t>(size) : static_cast<std::int64_t>(size);
}

/// Returns the integers; nullopt if they have more than 62 bits.
std::optional<LatticePoints> lattice_points(const FourMovingPoints& points) {
  LatticePoints out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    BitRange range;
    for (const auto* ends : {&points.start, &points.end}) {
      for (const Vec3d& p : *ends) range.add(p[axis]);
    }
    if (!range.is_normal || range.bits() > most_bits) return std::nullopt;
    out.bits = std::max(out.bits, range.bits());
    for (std::size_t k = 0; k < 4; ++k) {
      out.start[k][axis] = integer(points.start[k][axis], range.low);
      out.end[k][axis] = integer(points.end[k][axis], range.low);
    }
  }
  return out;
}

template <class Number>
using Vector = std::array<Number, 3>;

/// Integers for a test of two features. With coordinates below 2^b, intermediate results are below 2^(5b + 12), and
/// times are fractions of numbers below 2^(3b + 7).
__extension__ using Int128 = __int128;
using Int384 = FixedInteger<384>;
constexpr int bits_for_64 = 10;
constexpr int bits_for_128 = 23;

template <class Number>
int sign_of(const Number& x) {
  return x > 0 ? 1 : (x < 0 ? -1 : 0);
}

/// A function of time that is linear in [0, 1], given by its values at 0 and 1.
template <class Number>
struct Linear {
  Number start;
  Number end;

  friend Linear operator-(const Linear& a, const Linear& b) { return {a.start - b.start, a.end - b.end}; }
};

/// The time above / (above + below). Both are at least 0, and one is above 0.
template <class Number>
struct Time {
  Number above;
  Number below;
};

template <class Number>
bool is_later(const Time<Number>& a, const Time<Number>& b) {
  return a.above * b.below > b.above * a.below;
}

/// Returns the value of a function at a time, times a positive number.
template <class Number>
Number at(const Time<Number>& t, const Linear<Number>& function) {
  return function.start * t.below + function.end * t.above;
}

/// Times at which conditions hold: those from `first` to `last`. All conditions are linear, so the times are an
/// interval.
template <class Number>
class Times {
 public:
  /// Adds the condition that the function is 0. @return false if no time is left.
  bool require_zero(const Linear<Number>& function) {
    const int start = sign_of(function.start);
    const int end = sign_of(function.end);
    if (start == 0 && end == 0) return true;
    if (start * end > 0) return false;
    if (is_moment_) return at(first_, function) == 0;
    is_moment_ = true;
    first_ = start < 0 || end > 0 ? Time<Number>{-function.start, function.end}
                                  : Time<Number>{function.start, -function.end};
    return true;
  }

  /// Adds the condition that the function is not negative. Zeros must be required before. @return false if no time is
  /// left.
  bool require_not_negative(const Linear<Number>& function) {
    const bool is_at_start = !(function.start < 0);
    const bool is_at_end = !(function.end < 0);
    if (is_at_start && is_at_end) return true;
    if (!is_at_start && !is_at_end) return false;
    if (is_moment_) return !(at(first_, function) < 0);
    if (is_at_start) {
      const Time<Number> exit{function.start, -function.end};
      if (is_later(last_, exit)) last_ = exit;
    } else {
      const Time<Number> entry{-function.start, function.end};
      if (is_later(entry, first_)) first_ = entry;
    }
    return !is_later(first_, last_);
  }

  [[nodiscard]] const Time<Number>& first() const { return first_; }

 private:
  Time<Number> first_{0, 1};
  Time<Number> last_{1, 0};
  bool is_moment_ = false;  ///< true if only the time `first` is left
};

/// Two features that translate, given by vectors between their points. The vectors are the sides u and v of a face, or
/// both edges, and the vector w between the features. Two edges meet if s u = w + r v. A vertex and a face meet if w =
/// s u + r v.
template <class Number>
class Shifted {
 public:
  Shifted(const LatticePoints& points, FeatureKinds kinds) : is_face_(kinds == FeatureKinds::vertex_face) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto between = [&](std::size_t from, std::size_t to) {
        return Number(points.start[to][axis] - points.start[from][axis]);
      };
      u_[axis] = is_face_ ? between(1, 2) : between(0, 1);
      v_[axis] = is_face_ ? between(1, 3) : between(2, 3);
      const std::size_t from = is_face_ ? 1 : 0;
      const std::size_t to = is_face_ ? 0 : 2;
      w_start_[axis] = between(from, to);
      w_end_[axis] = Number(points.end[to][axis] - points.end[from][axis]);
    }
  }

  [[nodiscard]] FilteredImpact impact(int depth) const {
    const Vector<Number> normal{cross(u_, v_, 0), cross(u_, v_, 1), cross(u_, v_, 2)};
    const auto axis = static_cast<std::size_t>(
        std::find_if(normal.begin(), normal.end(), [](const Number& n) { return n != 0; }) - normal.begin());
    Times<Number> times;
    if (axis < 3) {
      const bool meet =
          times.require_zero({dot(normal, w_start_), dot(normal, w_end_)}) && overlap(normal[axis], axis, times);
      return meet ? at_first(times, depth) : FilteredImpact{Answer::never, 0};
    }
    const auto length_axis = [](const Vector<Number>& edge) {
      return static_cast<std::size_t>(std::find_if(edge.begin(), edge.end(), [](const Number& x) { return x != 0; }) -
                                      edge.begin());
    };
    if (is_face_ || length_axis(u_) == 3 || length_axis(v_) == 3) return {};
    return are_collinear(times) && overlap_on_line(length_axis(u_), times) ? at_first(times, depth)
                                                                           : FilteredImpact{Answer::never, 0};
  }

 private:
  static Number cross(const Vector<Number>& a, const Vector<Number>& b, std::size_t axis) {
    const std::size_t next = (axis + 1) % 3;
    const std::size_t last = (axis + 2) % 3;
    return a[next] * b[last] - a[last] * b[next];
  }
  static Number dot(const Vector<Number>& a, const Vector<Number>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }

  /// Requires that s and r, times a component of the normal, belong to points of the features.
  [[nodiscard]] bool overlap(const Number& normal, std::size_t axis, Times<Number>& times) const {
    const bool is_down = normal < 0;
    const auto weight = [&](const Vector<Number>& edge, bool is_reversed) {
      const Linear<Number> out{cross(w_start_, edge, axis), cross(w_end_, edge, axis)};
      return is_reversed == is_down ? out : Linear<Number>{-out.start, -out.end};
    };
    const Number size = is_down ? Number(-normal) : normal;
    const Linear<Number> whole{size, size};
    const Linear<Number> s = weight(v_, false);
    const Linear<Number> r = weight(u_, is_face_);
    if (!times.require_not_negative(s) || !times.require_not_negative(r)) return false;
    if (is_face_) return times.require_not_negative(whole - s - r);
    return times.require_not_negative(whole - s) && times.require_not_negative(whole - r);
  }

  /// Requires that parallel edges lie on one line.
  [[nodiscard]] bool are_collinear(Times<Number>& times) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!times.require_zero({cross(u_, w_start_, axis), cross(u_, w_end_, axis)})) return false;
    }
    return true;
  }

  /// Requires that edges on one line overlap. On this line, points are ordered by a coordinate.
  [[nodiscard]] bool overlap_on_line(std::size_t axis, Times<Number>& times) const {
    const bool is_down = u_[axis] < 0;
    const auto upwards = [&](const Number& x) { return is_down ? Number(-x) : x; };
    const Number u = upwards(u_[axis]);
    const Number v = upwards(v_[axis]);
    const Linear<Number> w{upwards(w_start_[axis]), upwards(w_end_[axis])};
    const Linear<Number> other{w.start + v, w.end + v};
    const Linear<Number>& low = v < 0 ? other : w;
    const Linear<Number>& high = v < 0 ? w : other;
    return times.require_not_negative(high) && times.require_not_negative(Linear<Number>{u, u} - low);
  }

  static FilteredImpact at_first(const Times<Number>& times, int depth) {
    // A number of 64 bits has no room for the factor 2^depth.
    using Wide = std::conditional_t<sizeof(Number) <= 8, Int128, Number>;
    const Wide above(times.first().above);
    const Wide below(times.first().below);
    const Wide cell = (above << depth) / (above + below);
    return {Answer::meets, std::ldexp(static_cast<double>(cell), -depth)};
  }

  bool is_face_;
  Vector<Number> u_, v_;
  Vector<Number> w_start_, w_end_;
};

/// Returns true if some points move by exactly the same vector.
bool shift_together(const LatticePoints& points, std::initializer_list<std::size_t> which) {
  const std::size_t first = *which.begin();
  return std::all_of(which.begin() + 1, which.end(), [&](std::size_t k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (points.end[k][axis] - points.start[k][axis] != points.end[first][axis] - points.start[first][axis]) {
        return false;
      }
    }
    return true;
  });
}

}  // namespace

FilteredImpact shifted_impact(const FourMovingPoints& points, FeatureKinds kinds, double tolerance) {
  const std::optional<LatticePoints> integers = lattice_points(points);
  if (!integers) return {};
  const bool both_shift = kinds == FeatureKinds::vertex_face
                              ? shift_together(*integers, {1, 2, 3})
                              : shift_together(*integers, {0, 1}) && shift_together(*integers, {2, 3});
  if (!both_shift) return {};
  const int depth = time_depth(tolerance);
  if (integers->bits <= bits_for_64) return Shifted<std::int64_t>(*integers, kinds).impact(depth);
  if (integers->bits <= bits_for_128) return Shifted<Int128>(*integers, kinds).impact(depth);
  return Shifted<Int384>(*integers, kinds).impact(depth);
}

}  // namespace blum::detail
