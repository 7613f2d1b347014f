#include "voronoi/planes/half_spaces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace blum::voronoi {
namespace {

constexpr double rounding = 0x1p-53;

using Matrix = std::array<std::array<double, 4>, 4>;

/// Returns numerator / denominator * 2^exponent, rounded.
double ratio(const Integer& numerator, const Integer& denominator, int exponent = 0) {
  if (numerator.is_zero()) return 0;
  Integer top = abs(numerator);
  Integer bottom = abs(denominator);
  const int shift = 66 - static_cast<int>(msb(top)) + static_cast<int>(msb(bottom));
  if (shift >= 0) {
    top = detail::times_power(std::move(top), shift);
  } else {
    bottom = detail::times_power(std::move(bottom), -shift);
  }
  const Integer quotient = top / bottom;
  const double magnitude = std::ldexp(quotient.convert_to<double>(), exponent - shift);
  return numerator.sign() == denominator.sign() ? magnitude : -magnitude;
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

/// The determinants of all three of up to five vectors, by the indices of the three.
class Minors {
 public:
  explicit Minors(const std::vector<const std::array<Integer, 3>*>& vectors) {
    const auto count = static_cast<std::uint32_t>(vectors.size());
    for (std::uint32_t a = 0; a < count; ++a) {
      for (std::uint32_t b = a + 1; b < count; ++b) {
        for (std::uint32_t c = b + 1; c < count; ++c) {
          values_[1U << a | 1U << b | 1U << c] = det3(*vectors[a], *vectors[b], *vectors[c]);
        }
      }
    }
  }
  /// @param which  a bit for each of the three vectors.
  [[nodiscard]] const Integer& of(std::uint32_t which) const { return values_[which]; }

 private:
  std::array<Integer, 32> values_;
};

}  // namespace

HalfSpaces::HalfSpaces(const std::vector<IntegerPlane>& planes, const Integer& reach, double unit)
    : count_(static_cast<Index>(planes.size())), exponent_(std::ilogb(unit)), size_(ratio(reach, 1, exponent_)) {
  for (const IntegerPlane& plane : planes) add(plane, 1);
  add({{0, 0, 0}, 0}, -1);
  const Integer far = 16 * reach;
  for (std::size_t k = 0; k < 6; ++k) {
    IntegerPlane side{{0, 0, 0}, far};
    side.normal[k / 2] = k % 2 == 0 ? 1 : -1;
    add(std::move(side), 0);
  }
}

void HalfSpaces::add(IntegerPlane plane, int weight) {
  const auto& [x, y, z] = plane.normal;
  Integer square = x * x + y * y + z * z;
  if (weight < 0) square = 1;
  // The normal times the magnitude of the weight is a unit vector. Ratios of integers keep it precise.
  constexpr int bits = Root::stored_bits[0];
  Root root(std::move(square));
  const Integer length = root.times_power(bits);
  Row row;
  for (std::size_t k = 0; k < 3; ++k) row.normal[k] = ratio(detail::times_power(plane.normal[k], bits), length);
  row.offset = ratio(detail::times_power(plane.offset, bits), length, exponent_);
  row.weight = weight;
  rows_.push_back(row);
  exact_.push_back({std::move(plane), weight, std::move(root)});
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

PlacedCorner HalfSpaces::place_exactly(const Base& base) const {
  constexpr int bits = Root::stored_bits[1];
  // The columns are normal, weight and offset of each row, times 2^bits.
  std::array<std::array<Integer, 5>, 4> rows;
  for (std::size_t k = 0; k < 4; ++k) {
    const ExactRow& row = exact_[base[k]];
    for (std::size_t c = 0; c < 3; ++c) rows[k][c] = detail::times_power(row.plane.normal[c], bits);
    rows[k][3] = -row.weight * row.root.times_power(bits);
    rows[k][4] = -detail::times_power(row.plane.offset, bits);
  }
  const auto det = [&](std::size_t replaced) {
    std::array<std::array<Integer, 3>, 4> first;
    std::array<Integer, 4> last;
    const auto entry = [&](std::size_t k, std::size_t c) -> const Integer& { return rows[k][c == replaced ? 4 : c]; };
    for (std::size_t k = 0; k < 4; ++k) {
      first[k] = {entry(k, 0), entry(k, 1), entry(k, 2)};
      last[k] = entry(k, 3);
    }
    return Integer(-last[0] * det3(first[1], first[2], first[3]) + last[1] * det3(first[0], first[2], first[3]) -
                   last[2] * det3(first[0], first[1], first[3]) + last[3] * det3(first[0], first[1], first[2]));
  };
  const Integer all = det(5);
  PlacedCorner out = place(base);
  if (all.is_zero()) return out;
  for (std::size_t k = 0; k < 3; ++k) out.at[k] = ratio(det(k), all, exponent_);
  out.height = ratio(det(3), all, exponent_);
  out.error = 2 * rounding * std::max({std::abs(out.at.x), std::abs(out.at.y), std::abs(out.at.z), out.height});
  return out;
}

int HalfSpaces::side(const Base& base, const PlacedCorner& placed, Index of) const {
  const Row& row = rows_[of];
  const double value = dot(row.normal, placed.at) + row.offset - row.weight * placed.height;
  const double scale = std::abs(placed.at.x) + std::abs(placed.at.y) + std::abs(placed.at.z) + std::abs(placed.height) +
                       std::abs(row.offset);
  const double error = 3 * placed.error + 16 * rounding * scale;
  if (value > error) return 1;
  if (value < -error) return -1;
  return exact_side(base, of);
}

int HalfSpaces::exact_side(const Base& base, Index of) const {
  const std::array<const ExactRow*, 5> rows{&exact_[base[0]], &exact_[base[1]], &exact_[base[2]], &exact_[base[3]],
                                            &exact_[of]};
  std::vector<const std::array<Integer, 3>*> normals;
  for (const ExactRow* row : rows) normals.push_back(&row->plane.normal);
  const Minors minors(normals);
  // Both determinants are expanded along the column of weights, so that their terms are integers times roots.
  const auto sign_without = [&](std::size_t count) {
    std::vector<RootTerm> terms;
    for (std::uint32_t k = 0; k < count; ++k) {
      const ExactRow& row = *rows[k];
      if (row.weight == 0) continue;
      const std::uint32_t others = ((1U << count) - 1) & ~(1U << k);
      Integer minor = 0;
      if (count == 4) {
        minor = minors.of(others);
      } else {
        // The minor of normals and offsets, expanded along the offsets.
        int sign = -1;
        for (std::uint32_t m = 0; m < count; ++m) {
          if (m == k) continue;
          const Integer& part = minors.of(others & ~(1U << m));
          if (sign < 0) {
            minor -= rows[m]->plane.offset * part;
          } else {
            minor += rows[m]->plane.offset * part;
          }
          sign = -sign;
        }
      }
      // (-1)^(k + 3) times the entry, which is minus the weight.
      if ((k % 2 == 0) != (row.weight > 0)) minor = -minor;
      terms.push_back({std::move(minor), &row.root});
    }
    return sign_of_root_sum(terms);
  };
  return sign_without(4) * sign_without(5);
}

}  // namespace blum::voronoi
