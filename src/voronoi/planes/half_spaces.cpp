#include "voronoi/planes/half_spaces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "blum/core/parallel.hpp"

namespace blum::voronoi {
namespace {

using detail::Double2;

constexpr double rounding = 0x1p-53;
/// Bound on the relative error of a few operations with twice the digits.
constexpr double fine_rounding = 0x1p-98;
constexpr std::size_t planes_per_range = 64;

using Matrix = std::array<std::array<double, 4>, 4>;

/// Returns numerator / denominator * 2^exponent, rounded to twice the digits of a double.
Double2 ratio(const Integer& numerator, const Integer& denominator, int exponent = 0) {
  if (numerator.is_zero()) return {};
  Integer top = abs(numerator);
  Integer bottom = abs(denominator);
  constexpr int digits = 130;
  const int shift = digits - static_cast<int>(msb(top)) + static_cast<int>(msb(bottom));
  if (shift >= 0) {
    top = detail::times_power(std::move(top), shift);
  } else {
    bottom = detail::times_power(std::move(bottom), -shift);
  }
  const Integer quotient = top / bottom;
  const auto high = quotient.convert_to<double>();
  const auto low = Integer(quotient - Integer(high)).convert_to<double>();
  const double sign = numerator.sign() == denominator.sign() ? 1 : -1;
  return {std::ldexp(sign * high, exponent - shift), std::ldexp(sign * low, exponent - shift)};
}

/// Inverts a matrix by elimination with pivots. Returns false if a pivot is 0.
bool invert(Matrix a, Matrix& out) {
  out = {};
  for (std::size_t k = 0; k < 4; ++k) out[k][k] = 1;
  for (std::size_t k = 0; k < 4; ++k) {
    std::size_t pivot = k;
    for (std::size_t row = k + 1; row < 4; ++row) {
      if (std::abs(a[row][k]) > std::abs(a[pivot][k])) pivot = row;
    }
    if (!(std::abs(a[pivot][k]) > 0)) return false;
    std::swap(a[k], a[pivot]);
    std::swap(out[k], out[pivot]);
    const double scale = 1 / a[k][k];
    for (std::size_t c = 0; c < 4; ++c) {
      a[k][c] *= scale;
      out[k][c] *= scale;
    }
    for (std::size_t row = 0; row < 4; ++row) {
      if (row == k) continue;
      const double factor = a[row][k];
      for (std::size_t c = 0; c < 4; ++c) {
        a[row][c] -= factor * a[k][c];
        out[row][c] -= factor * out[k][c];
      }
    }
  }
  return true;
}

/// Returns the largest sum of magnitudes in a row.
double norm(const Matrix& a) {
  double out = 0;
  for (const auto& row : a) {
    double sum = 0;
    for (const double entry : row) sum += std::abs(entry);
    out = std::max(out, sum);
  }
  return out;
}

Integer det3(const std::array<Integer, 3>& a, const std::array<Integer, 3>& b, const std::array<Integer, 3>& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// A sum of integers times roots, times 2^bits.
struct RoundedSum {
  Integer value = 0;
  Integer error = 0;
};

template <class Factor>
RoundedSum sum_of(const ExactCorner& corner, int bits, const Factor& factor) {
  RoundedSum out;
  for (std::size_t k = 0; k < corner.count; ++k) {
    const Integer& by = factor(corner.terms[k]);
    out.value += by * corner.terms[k].root->times_power(bits);
    out.error += abs(by);
  }
  return out;
}

double magnitude(const Double2& value) {
  return std::abs(value.high);
}

}  // namespace

HalfSpaces::HalfSpaces(const std::vector<IntegerPlane>& planes, const Integer& reach, double unit,
                       const Context& context)
    : count_(static_cast<Index>(planes.size())),
      exponent_(std::ilogb(unit)),
      size_(ratio(reach, 1, exponent_).high),
      rows_(planes.size() + 7),
      exact_(planes.size() + 7) {
  parallel_for(context, count_, planes_per_range, "planes", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) set(static_cast<Index>(k), planes[k], 1);
  });
  set(floor(), {{0, 0, 0}, 0}, -1);
  const Integer far = 16 * reach;
  for (Index k = 0; k < 6; ++k) {
    IntegerPlane side{{0, 0, 0}, far};
    side.normal[k / 2] = k % 2 == 0 ? 1 : -1;
    set(box_side(k), std::move(side), 0);
  }
}

void HalfSpaces::set(Index k, IntegerPlane plane, int weight) {
  const auto& [x, y, z] = plane.normal;
  Integer square = x * x + y * y + z * z;
  if (weight < 0) square = 1;
  // The normal times the magnitude of the weight is a unit vector. Ratios of integers keep it precise.
  constexpr int bits = Root::stored_bits.back();
  ExactRow& exact = exact_[k];
  exact.root = Root(std::move(square));
  const Integer length = exact.root.times_power(bits);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    exact.row[axis] = ratio(detail::times_power(plane.normal[axis], bits), length);
    rows_[k].normal[axis] = exact.row[axis].high;
  }
  exact.row[3] = ratio(detail::times_power(plane.offset, bits), length, exponent_);
  rows_[k].offset = exact.row[3].high;
  rows_[k].weight = weight;
  exact.plane = std::move(plane);
  exact.weight = weight;
}

PlacedCorner HalfSpaces::place(const Base& base) const {
  Matrix a;
  std::array<double, 4> right{};
  for (std::size_t k = 0; k < 4; ++k) {
    const Row& row = rows_[base[k]];
    a[k] = {row.normal.x, row.normal.y, row.normal.z, -row.weight};
    right[k] = -row.offset;
  }
  constexpr double unknown = std::numeric_limits<double>::infinity();
  Matrix inverse;
  if (!invert(a, inverse)) return {{}, 0, unknown, unknown};
  std::array<double, 4> point{};
  const auto correct = [&](const std::array<double, 4>& residual) {
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t c = 0; c < 4; ++c) point[k] += inverse[k][c] * residual[c];
    }
  };
  const auto residual = [&] {
    std::array<double, 4> out{};
    for (std::size_t k = 0; k < 4; ++k) {
      out[k] = right[k];
      for (std::size_t c = 0; c < 4; ++c) out[k] -= a[k][c] * point[c];
    }
    return out;
  };
  correct(right);
  correct(residual());
  Matrix rest{};
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t c = 0; c < 4; ++c) {
      rest[k][c] = k == c ? 1 : 0;
      for (std::size_t m = 0; m < 4; ++m) rest[k][c] -= inverse[k][m] * a[m][c];
    }
  }
  // The rows have errors of 2 roundings for each entry. The computed rest has those of sums of products of the rows,
  // each at most 1, and the inverse.
  const double size = norm(inverse);
  const double contraction = norm(rest) + 32 * rounding * size;
  if (!(contraction < 0.5)) return {{}, 0, unknown, unknown};
  double worst = 0;
  double scale = size_;
  for (const double value : residual()) worst = std::max(worst, std::abs(value));
  for (const double value : point) scale = std::max(scale, std::abs(value));
  for (const double value : right) scale = std::max(scale, std::abs(value));
  const double error = size / (1 - contraction) * (worst + 32 * rounding * scale);
  return {{point[0], point[1], point[2]}, point[3], error, size / (1 - contraction)};
}

ExactCorner HalfSpaces::exact_corner(const Base& base) const {
  // The product of the rows (normal, -weight, offset) with a vector is 0 for the vector of minors. Minors with the
  // column of weights are expanded along it, so that their terms are integers times roots.
  ExactCorner out;
  const bool is_in_floor = std::find(base.begin(), base.end(), floor()) != base.end();
  bool is_even = true;
  for (std::size_t k = 0; k < 4; ++k, is_even = !is_even) {
    std::array<std::array<Integer, 3>, 4> columns;  // of the three other rows
    std::size_t row = 0;
    for (std::size_t m = 0; m < 4; ++m) {
      if (m == k) continue;
      const IntegerPlane& plane = exact_[base[m]].plane;
      for (std::size_t axis = 0; axis < 3; ++axis) columns[axis][row] = plane.normal[axis];
      columns[3][row++] = plane.offset;
    }
    const Integer all = det3(columns[0], columns[1], columns[2]);
    const ExactRow& own = exact_[base[k]];
    const Integer part = own.plane.offset * all;
    out.height += is_even ? part : Integer(-part);
    // A vertex in the floor has one term: the others would be minors with the row of the floor.
    const bool is_zero = is_in_floor && base[k] != floor();
    if (own.weight == 0 || is_zero) continue;
    ExactCorner::Term& term = out.terms[out.count++];
    term.root = &own.root;
    term.at = {-det3(columns[1], columns[2], columns[3]), det3(columns[0], columns[2], columns[3]),
               -det3(columns[0], columns[1], columns[3])};
    term.all = all;
    if (is_even == (own.weight > 0)) continue;
    for (Integer& factor : term.at) factor = -factor;
    term.all = -term.all;
  }
  std::array<RootTerm, 4> terms;
  for (std::size_t k = 0; k < out.count; ++k) terms[k] = {out.terms[k].all, out.terms[k].root};
  out.sign = sign_of_root_sum(std::span(terms).first(out.count));
  return out;
}

void HalfSpaces::place(ExactCorner& corner) const {
  if (corner.is_placed || corner.sign == 0) return;
  corner.is_placed = true;
  // The bits double until cancellation leaves enough of them.
  constexpr int enough = 120;
  int bits = Root::stored_bits.back();
  const auto denominator = [](const ExactCorner::Term& term) -> const Integer& { return term.all; };
  RoundedSum all = sum_of(corner, bits, denominator);
  while (abs(all.value) <= detail::times_power(all.error, enough)) {
    bits *= 2;
    all = sum_of(corner, bits, denominator);
  }
  corner.error = 0;
  const double share = ratio(all.error, all.value).high;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const RoundedSum top =
        sum_of(corner, bits, [&](const ExactCorner::Term& term) -> const Integer& { return term.at[axis]; });
    corner.placed[axis] = ratio(top.value, all.value, exponent_);
    corner.error = std::max(corner.error, magnitude(ratio(top.error, all.value, exponent_)));
  }
  corner.placed[3] = ratio(detail::times_power(corner.height, bits), all.value, exponent_);
  double largest = 0;
  for (const Double2& value : corner.placed) largest = std::max(largest, magnitude(value));
  corner.error = 2 * (corner.error + largest * (std::abs(share) + fine_rounding));
}

PlacedCorner HalfSpaces::place_exactly(const Base& base) const {
  ExactCorner corner = exact_corner(base);
  place(corner);
  PlacedCorner out = rounded(corner);
  out.condition = place(base).condition;
  return out;
}

PlacedCorner HalfSpaces::rounded(const ExactCorner& corner) {
  const auto& [x, y, z, height] = corner.placed;
  double largest = 0;
  for (const Double2& value : corner.placed) largest = std::max(largest, magnitude(value));
  return {{x.high, y.high, z.high},
          height.high,
          corner.error + 2 * rounding * largest,
          std::numeric_limits<double>::infinity()};
}

double HalfSpaces::depth(const PlacedCorner& placed, Index of) const {
  const Row& row = rows_[of];
  const double value = dot(row.normal, placed.at) + row.offset - row.weight * placed.height;
  const double scale = std::abs(placed.at.x) + std::abs(placed.at.y) + std::abs(placed.at.z) + std::abs(placed.height) +
                       std::abs(row.offset);
  const double error = 3 * placed.error + 16 * rounding * scale;
  return std::abs(value) > error ? value : 0;
}

HalfSpaces::Position HalfSpaces::position(const ExactCorner& corner, Index of) const {
  const ExactRow& exact = exact_[of];
  if (!corner.is_placed) return {exact_side(corner, exact), 0};
  Double2 value = exact.row[3];
  double scale = magnitude(value) + magnitude(corner.placed[3]);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    value = sum(value, product(exact.row[axis], corner.placed[axis]));
    scale += magnitude(corner.placed[axis]);
  }
  if (exact.weight != 0) {
    const Double2 height = corner.placed[3];
    value = exact.weight > 0 ? sum(value, {-height.high, -height.low}) : sum(value, height);
  }
  const double error = 3 * corner.error + fine_rounding * scale;
  if (value.high > error) return {1, value.high};
  if (value.high < -error) return {-1, value.high};
  const int side = exact_side(corner, exact);
  return {side, side * std::abs(value.high)};
}

int HalfSpaces::exact_side(const ExactCorner& corner, const ExactRow& row) {
  std::array<RootTerm, 5> terms;
  std::size_t count = 0;
  for (; count < corner.count; ++count) {
    const ExactCorner::Term& term = corner.terms[count];
    const auto& [x, y, z] = row.plane.normal;
    terms[count] = {x * term.at[0] + y * term.at[1] + z * term.at[2] + row.plane.offset * term.all, term.root};
  }
  if (row.weight != 0) terms[count++] = {row.weight > 0 ? Integer(-corner.height) : corner.height, &row.root};
  return corner.sign * sign_of_root_sum(std::span(terms).first(count));
}

}  // namespace blum::voronoi
