// Blum: polynomials with integer coefficients. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <utility>
#include <vector>

#include "exact/integer.hpp"

namespace blum::detail {

/// The number numerator / 2^exponent.
struct Dyadic {
  Integer numerator = 0;
  unsigned exponent = 0;
};

/// A polynomial in one variable with integer coefficients.
class Polynomial {
 public:
  static constexpr std::size_t most_coefficients = 13;

  Polynomial() = default;
  /// Makes a polynomial from its coefficients, the constant one first.
  Polynomial(std::initializer_list<Integer> coefficients) {
    for (const Integer& c : coefficients) coefficients_[size_++] = c;
    trim();
  }

  // Only coefficients in use are copied. To copy the unused ones would take most of the time.
  Polynomial(const Polynomial& other) : size_(other.size_) {
    std::copy_n(other.coefficients_.begin(), size_, coefficients_.begin());
  }
  Polynomial(Polynomial&& other) noexcept : size_(other.size_) {
    std::move(other.coefficients_.begin(), other.coefficients_.begin() + static_cast<std::ptrdiff_t>(size_),
              coefficients_.begin());
  }
  Polynomial& operator=(const Polynomial& other) {
    if (this != &other) *this = Polynomial(other);
    return *this;
  }
  Polynomial& operator=(Polynomial&& other) noexcept {
    for (std::size_t k = 0; k < std::max(size_, other.size_); ++k) {
      coefficients_[k] = k < other.size_ ? std::move(other.coefficients_[k]) : Integer(0);
    }
    size_ = other.size_;
    return *this;
  }
  ~Polynomial() = default;

  /// Returns the degree; -1 for the polynomial zero.
  [[nodiscard]] int degree() const { return static_cast<int>(size_) - 1; }
  [[nodiscard]] bool is_zero() const { return size_ == 0; }
  [[nodiscard]] const Integer& operator[](std::size_t power) const { return coefficients_[power]; }
  [[nodiscard]] const Integer& leading() const { return coefficients_[size_ - 1]; }

  [[nodiscard]] int sign_at(const Dyadic& t) const;
  [[nodiscard]] Polynomial derivative() const;
  /// Returns the polynomial, times a positive number, divided by the factor (t - root) as often as possible.
  [[nodiscard]] Polynomial without_root(const Dyadic& root) const;

  /// Divides the coefficients by their positive greatest common divisor.
  void divide_by_content();

  friend Polynomial operator+(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator-(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator*(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator-(Polynomial a);
  /// Returns the remainder of a divided by b, times a positive number.
  friend Polynomial positive_remainder(Polynomial a, const Polynomial& b);

 private:
  void trim() {
    while (size_ > 0 && coefficients_[size_ - 1] == 0) --size_;
  }

  std::array<Integer, most_coefficients> coefficients_;
  std::size_t size_ = 0;
};

/// A root of a polynomial. If the root is exact, its value is cell / 2^depth. Otherwise, it is the only root between
/// cell / 2^depth and (cell + 1) / 2^depth, and neither end of this interval is a root.
struct RealRoot {
  Integer cell = 0;
  unsigned depth = 0;
  bool is_exact = false;

  [[nodiscard]] Dyadic low() const { return {cell, depth}; }
  [[nodiscard]] Dyadic high() const { return {cell + 1, depth}; }
  /// Returns the root, rounded down to a multiple of 2^-digits. The interval must be at most 2^-digits wide, and digits
  /// at most 52.
  [[nodiscard]] double rounded_down(unsigned digits) const;
};

/// Real roots of a polynomial in [0, 1], and the signs of other polynomials at these roots. All answers are exact.
/// Method: counts of roots by sequences of remainders (Sturm 1829), and of roots with a sign condition (Tarski 1951).
class RealRoots {
 public:
  /// @param polynomial  not zero.
  explicit RealRoots(Polynomial polynomial);

  /// Returns the roots, each once, in rising order.
  [[nodiscard]] const std::vector<RealRoot>& all() const { return roots_; }

  /// Returns the same root with an interval that is at most 2^-depth wide.
  [[nodiscard]] RealRoot refined(RealRoot root, unsigned depth) const;

  /// Returns the sign, -1, 0 or 1, of another polynomial at a root.
  [[nodiscard]] int sign_at(const RealRoot& root, const Polynomial& other) const;

 private:
  void isolate();
  void separate();
  [[nodiscard]] RealRoot guessed(const RealRoot& root, int low_sign, unsigned depth) const;
  [[nodiscard]] static int sign_over(const RealRoot& root, const Polynomial& other);

  Polynomial rest_;  ///< the polynomial without the roots that were found exactly
  std::vector<Polynomial> sequence_;
  std::vector<RealRoot> roots_;
};

}  // namespace blum::detail
