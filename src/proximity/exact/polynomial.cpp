#include "proximity/exact/polynomial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace blum::detail {
namespace {

/// Returns the sequence that begins with two polynomials. Each further item is the negated remainder of dividing the
/// last item but one by the last item, times a positive number.
std::vector<Polynomial> remainders(const Polynomial& first, Polynomial second) {
  std::vector<Polynomial> all{first};
  while (!second.is_zero()) {
    Polynomial next = -positive_remainder(all.back(), second);
    if (next.degree() > 1) next.divide_by_content();
    all.push_back(std::move(second));
    second = std::move(next);
  }
  return all;
}

/// Returns the number of sign changes in a sequence of polynomials at t. Zeros are skipped.
int variations(const std::vector<Polynomial>& sequence, const Dyadic& t) {
  int changes = 0;
  int last = 0;
  for (const Polynomial& one : sequence) {
    const int sign = one.sign_at(t);
    if (sign == 0) continue;
    if (last != 0 && sign != last) ++changes;
    last = sign;
  }
  return changes;
}

bool is_less(const RealRoot& a, const RealRoot& b) {
  const Integer left = a.cell << b.depth;
  const Integer right = b.cell << a.depth;
  return left < right || (left == right && a.is_exact && !b.is_exact);
}

}  // namespace

double RealRoot::rounded_down(unsigned digits) const {
  const Integer whole = depth > digits ? Integer(cell >> (depth - digits)) : Integer(cell << (digits - depth));
  return std::ldexp(static_cast<double>(whole.convert_to<std::uint64_t>()), -static_cast<int>(digits));
}

RealRoots::RealRoots(Polynomial polynomial) : rest_(std::move(polynomial)) {
  for (const int end : {0, 1}) {
    if (rest_.degree() <= 0 || rest_.sign_at({end, 0}) != 0) continue;
    roots_.push_back({end, 0, true});
    rest_ = rest_.without_root({end, 0});
  }
  if (rest_.degree() > 0) isolate();
  separate();
  std::sort(roots_.begin(), roots_.end(), is_less);
}

/// Narrows the intervals of inexact roots until none of them contains an exact root.
void RealRoots::separate() {
  for (RealRoot& root : roots_) {
    const auto holds = [&](const RealRoot& other) {
      return other.is_exact && is_less(root, other) && is_less(other, {root.cell + 1, root.depth, true});
    };
    while (!root.is_exact && std::any_of(roots_.begin(), roots_.end(), holds)) root = refined(root, root.depth + 1);
  }
}

void RealRoots::isolate() {
  struct Interval {
    RealRoot cell;
    int low_variations;
    int high_variations;
  };
  sequence_ = remainders(rest_, rest_.derivative());
  std::vector<RealRoot> found;
  std::vector<Interval> left{{RealRoot{}, variations(sequence_, {0, 0}), variations(sequence_, {1, 0})}};
  while (!left.empty()) {
    const Interval interval = std::move(left.back());
    left.pop_back();
    const int count = interval.low_variations - interval.high_variations;
    if (count == 1) found.push_back(interval.cell);
    if (count < 2) continue;
    const RealRoot upper{2 * interval.cell.cell + 1, interval.cell.depth + 1};
    if (rest_.sign_at(upper.low()) == 0) {
      roots_.push_back({upper.cell, upper.depth, true});
      rest_ = rest_.without_root(upper.low());
      if (rest_.degree() > 0) isolate();
      return;
    }
    const int between = variations(sequence_, upper.low());
    left.push_back({{2 * interval.cell.cell, upper.depth}, interval.low_variations, between});
    left.push_back({upper, between, interval.high_variations});
  }
  roots_.insert(roots_.end(), found.begin(), found.end());
}

RealRoot RealRoots::refined(RealRoot root, unsigned depth) const {
  if (root.is_exact || root.depth >= depth) return root;
  const int low_sign = rest_.sign_at(root.low());
  const bool changes_sign = low_sign != rest_.sign_at(root.high());
  // A guess in double precision is usually correct. Exact signs verify the guess.
  constexpr unsigned double_digits = 50;
  if (changes_sign && depth <= double_digits) {
    const RealRoot guess = guessed(root, low_sign, depth);
    const bool is_within = guess.cell >= root.cell << (depth - root.depth) && guess.cell < (root.cell + 1)
                                                                                               << (depth - root.depth);
    if (is_within && rest_.sign_at(guess.low()) == low_sign && rest_.sign_at(guess.high()) == -low_sign) return guess;
  }
  const int low_variations = changes_sign ? 0 : variations(sequence_, root.low());
  while (root.depth < depth) {
    const RealRoot upper{2 * root.cell + 1, root.depth + 1};
    const int sign = rest_.sign_at(upper.low());
    if (sign == 0) return {upper.cell, upper.depth, true};
    const bool is_above = changes_sign ? sign == low_sign : variations(sequence_, upper.low()) == low_variations;
    root = is_above ? upper : RealRoot{2 * root.cell, upper.depth};
  }
  return root;
}

/// Returns an interval in [0, 1] of width 2^-depth that probably contains the root, found by bisection in doubles.
/// @param low_sign  sign of the polynomial just before the root.
RealRoot RealRoots::guessed(const RealRoot& root, int low_sign, unsigned depth) const {
  // All coefficients are divided by the same power of 2, so that the largest has at most 63 bits.
  unsigned most_bits = 0;
  for (int k = 0; k <= rest_.degree(); ++k) {
    const Integer& c = rest_[static_cast<std::size_t>(k)];
    if (c != 0) most_bits = std::max(most_bits, static_cast<unsigned>(msb(Integer(abs(c)))));
  }
  constexpr unsigned digits = 62;
  const unsigned shift = most_bits > digits ? most_bits - digits : 0;
  std::array<double, Polynomial::most_coefficients> c{};
  for (int k = 0; k <= rest_.degree(); ++k) {
    const auto power = static_cast<std::size_t>(k);
    const Integer magnitude = abs(rest_[power]) >> shift;
    c[power] = std::copysign(static_cast<double>(magnitude.convert_to<std::uint64_t>()), rest_[power] < 0 ? -1.0 : 1.0);
  }
  const auto value = [&](double t) {
    double sum = 0;
    for (int k = rest_.degree(); k >= 0; --k) sum = sum * t + c[static_cast<std::size_t>(k)];
    return sum;
  };
  double low = std::ldexp(static_cast<double>(root.cell.convert_to<std::uint64_t>()), -static_cast<int>(root.depth));
  double high = low + std::ldexp(1.0, -static_cast<int>(root.depth));
  for (unsigned k = root.depth; k < depth; ++k) {
    const double middle = 0.5 * (low + high);
    ((value(middle) > 0) == (low_sign > 0) ? low : high) = middle;
  }
  return {Integer(static_cast<std::uint64_t>(std::ldexp(low, static_cast<int>(depth)))), depth};
}

/// Returns the sign of a polynomial of degree 2 or less in the interval of a root; 0 if it may have several signs
/// there.
int RealRoots::sign_over(const RealRoot& root, const Polynomial& other) {
  const int low = other.sign_at(root.low());
  if (low == 0 || other.sign_at(root.high()) != low) return 0;
  if (other.degree() < 2) return low;
  // Twice the middle Bernstein coefficient of a + b t + c t^2: 2 a + b (low + high) + 2 c low high, times 4^depth.
  const Integer middle = (((other[0] << (root.depth + 1)) + other[1] * (2 * root.cell + 1)) << root.depth) +
                         other[2] * (root.cell * (root.cell + 1) * 2);
  return middle.sign() == low ? low : 0;
}

int RealRoots::sign_at(const RealRoot& root, const Polynomial& other) const {
  if (other.degree() <= 0) return other.is_zero() ? 0 : other.leading().sign();
  if (root.is_exact) return other.sign_at(root.low());
  if (other.degree() <= 2) {
    if (const int sign = sign_over(root, other)) return sign;
  }
  const std::vector<Polynomial> sequence = remainders(rest_, positive_remainder(rest_.derivative() * other, rest_));
  return variations(sequence, root.low()) - variations(sequence, root.high());
}

int Polynomial::sign_at(const Dyadic& t) const {
  if (size_ == 0) return 0;
  if (t.numerator == 0) return coefficients_[0].sign();
  // Horner's scheme for the value times 2^(exponent * degree).
  Integer value = coefficients_[size_ - 1];
  unsigned shift = 0;
  for (std::size_t k = size_ - 1; k-- > 0;) {
    shift += t.exponent;
    value *= t.numerator;
    value += coefficients_[k] << shift;
  }
  return value.sign();
}

Polynomial Polynomial::derivative() const {
  Polynomial out;
  for (std::size_t k = 1; k < size_; ++k) out.coefficients_[k - 1] = coefficients_[k] * static_cast<unsigned>(k);
  out.size_ = size_ > 0 ? size_ - 1 : 0;
  return out;
}

Polynomial Polynomial::without_root(const Dyadic& root) const {
  // If numerator / 2^exponent is in lowest terms, the coefficients of 2^exponent * t - numerator have no common
  // divisor. So the quotient of the polynomial by this factor has integer coefficients (Gauss).
  Dyadic factor = root;
  while (factor.exponent > 0 && !bit_test(factor.numerator, 0)) {
    factor.numerator >>= 1;
    --factor.exponent;
  }
  Polynomial whole = *this;
  while (whole.size_ > 1 && whole.sign_at(root) == 0) {
    Polynomial quotient;
    quotient.size_ = whole.size_ - 1;
    if (factor.numerator == 0) {
      std::copy_n(whole.coefficients_.begin() + 1, quotient.size_, quotient.coefficients_.begin());
    } else {
      Integer carry = 0;
      for (std::size_t k = quotient.size_; k > 0; --k) {
        quotient.coefficients_[k - 1] = (whole.coefficients_[k] + carry) >> factor.exponent;
        carry = quotient.coefficients_[k - 1] * factor.numerator;
      }
    }
    whole = std::move(quotient);
  }
  return whole;
}

void Polynomial::divide_by_content() {
  if (size_ == 0) return;
  Integer common = abs(coefficients_[size_ - 1]);
  for (std::size_t k = 0; k + 1 < size_ && common != 1; ++k) {
    if (coefficients_[k] != 0) common = gcd(common, coefficients_[k]);
  }
  if (common == 1) return;
  for (std::size_t k = 0; k < size_; ++k) coefficients_[k] /= common;
}

Polynomial operator+(const Polynomial& a, const Polynomial& b) {
  Polynomial out = a;
  out.size_ = std::max(a.size_, b.size_);
  for (std::size_t k = 0; k < b.size_; ++k) out.coefficients_[k] += b.coefficients_[k];
  out.trim();
  return out;
}

Polynomial operator-(const Polynomial& a, const Polynomial& b) {
  Polynomial out = a;
  out.size_ = std::max(a.size_, b.size_);
  for (std::size_t k = 0; k < b.size_; ++k) out.coefficients_[k] -= b.coefficients_[k];
  out.trim();
  return out;
}

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  Polynomial out;
  if (a.is_zero() || b.is_zero()) return out;
  out.size_ = a.size_ + b.size_ - 1;
  for (std::size_t i = 0; i < a.size_; ++i) {
    for (std::size_t k = 0; k < b.size_; ++k) out.coefficients_[i + k] += a.coefficients_[i] * b.coefficients_[k];
  }
  return out;
}

Polynomial operator-(Polynomial a) {
  for (std::size_t k = 0; k < a.size_; ++k) a.coefficients_[k] = -a.coefficients_[k];
  return a;
}

Polynomial positive_remainder(Polynomial a, const Polynomial& b) {
  const bool is_negative = b.leading() < 0;
  const Integer leading = abs(b.leading());
  while (a.size_ >= b.size_) {
    const Integer factor = is_negative ? Integer(-a.leading()) : a.leading();
    const std::size_t shift = a.size_ - b.size_;
    for (std::size_t k = 0; k + 1 < a.size_; ++k) {
      a.coefficients_[k] *= leading;
      if (k >= shift) a.coefficients_[k] -= factor * b.coefficients_[k - shift];
    }
    a.coefficients_[a.size_ - 1] = 0;
    --a.size_;
    a.trim();
  }
  return a;
}

}  // namespace blum::detail
