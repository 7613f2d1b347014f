#include "proximity/polynomial.hpp"

#include <algorithm>
#include <utility>

namespace blum::detail {

int Polynomial::sign_at(const Dyadic& t) const {
  if (size_ == 0) return 0;
  if (t.numerator == 0) return coefficients_[0].sign();
  // Horner's scheme for 2^(exponent * degree) times the value.
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
  // In lowest terms, the coefficients of 2^exponent * t - numerator have no common divisor, so that the quotient by it
  // is of integers (Gauss).
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
