#include "exact/exact_integer.hpp"

#include <bit>
#include <cmath>
#include <utility>

namespace blum::detail {
namespace {

constexpr std::size_t limb_bits = 32;

}  // namespace

ExactInteger::ExactInteger(std::int64_t value) : negative_(value < 0) {
  auto magnitude = static_cast<std::uint64_t>(value);
  if (negative_) magnitude = ~magnitude + 1;
  for (; magnitude != 0; magnitude >>= limb_bits) limbs_.push_back(static_cast<Limb>(magnitude));
}

std::size_t ExactInteger::bits() const {
  if (limbs_.empty()) return 0;
  return limbs_.size() * limb_bits - static_cast<std::size_t>(std::countl_zero(limbs_.back()));
}

std::size_t ExactInteger::twos() const {
  for (std::size_t k = 0; k < limbs_.size(); ++k) {
    if (limbs_[k] != 0) return k * limb_bits + static_cast<std::size_t>(std::countr_zero(limbs_[k]));
  }
  return 0;
}

void ExactInteger::trim() {
  while (!limbs_.empty() && limbs_.back() == 0) limbs_.pop_back();
  if (limbs_.empty()) negative_ = false;
}

ExactInteger ExactInteger::operator-() const {
  ExactInteger out = *this;
  out.negative_ = !negative_ && !limbs_.empty();
  return out;
}

ExactInteger ExactInteger::operator<<(std::size_t count) const {
  ExactInteger out;
  if (limbs_.empty()) return out;
  out.negative_ = negative_;
  const std::size_t whole = count / limb_bits;
  const std::size_t part = count % limb_bits;
  out.limbs_.assign(whole, 0);
  std::uint64_t carry = 0;
  for (const Limb limb : limbs_) {
    carry |= static_cast<std::uint64_t>(limb) << part;
    out.limbs_.push_back(static_cast<Limb>(carry));
    carry >>= limb_bits;
  }
  out.limbs_.push_back(static_cast<Limb>(carry));
  out.trim();
  return out;
}

ExactInteger ExactInteger::operator>>(std::size_t count) const {
  ExactInteger out;
  const std::size_t whole = count / limb_bits;
  const std::size_t part = count % limb_bits;
  if (whole >= limbs_.size()) return out;
  out.negative_ = negative_;
  for (std::size_t k = whole; k < limbs_.size(); ++k) {
    const std::uint64_t above = k + 1 < limbs_.size() ? limbs_[k + 1] : 0;
    out.limbs_.push_back(static_cast<Limb>(((above << limb_bits) | limbs_[k]) >> part));
  }
  out.trim();
  return out;
}

void ExactInteger::halve() {
  for (std::size_t k = 0; k < limbs_.size(); ++k) {
    const std::uint64_t above = k + 1 < limbs_.size() ? limbs_[k + 1] : 0;
    limbs_[k] = static_cast<Limb>(((above << limb_bits) | limbs_[k]) >> 1U);
  }
  trim();
}

int ExactInteger::compare_magnitudes(const ExactInteger& a, const ExactInteger& b) {
  if (a.limbs_.size() != b.limbs_.size()) return a.limbs_.size() < b.limbs_.size() ? -1 : 1;
  for (std::size_t k = a.limbs_.size(); k-- > 0;) {
    if (a.limbs_[k] != b.limbs_[k]) return a.limbs_[k] < b.limbs_[k] ? -1 : 1;
  }
  return 0;
}

void ExactInteger::add_magnitude(std::vector<Limb>& to, const std::vector<Limb>& what) {
  if (to.size() < what.size()) to.resize(what.size(), 0);
  std::uint64_t carry = 0;
  for (std::size_t k = 0; k < to.size() && (k < what.size() || carry != 0); ++k) {
    carry += static_cast<std::uint64_t>(to[k]) + (k < what.size() ? what[k] : 0);
    to[k] = static_cast<Limb>(carry);
    carry >>= limb_bits;
  }
  if (carry != 0) to.push_back(static_cast<Limb>(carry));
}

void ExactInteger::take_magnitude(std::vector<Limb>& to, const std::vector<Limb>& what) {
  std::uint64_t borrow = 0;
  for (std::size_t k = 0; k < to.size() && (k < what.size() || borrow != 0); ++k) {
    const std::uint64_t take = borrow + (k < what.size() ? what[k] : 0);
    borrow = take > to[k] ? 1 : 0;
    to[k] = static_cast<Limb>(to[k] - take);
  }
}

ExactInteger ExactInteger::sum(const ExactInteger& a, const ExactInteger& b, bool b_negative) {
  if (b.limbs_.empty()) return a;
  ExactInteger out;
  if (a.negative_ == b_negative || a.limbs_.empty()) {
    out.limbs_ = a.limbs_;
    out.negative_ = b_negative;
    add_magnitude(out.limbs_, b.limbs_);
    return out;
  }
  const bool a_is_larger = compare_magnitudes(a, b) >= 0;
  out.limbs_ = a_is_larger ? a.limbs_ : b.limbs_;
  out.negative_ = a_is_larger ? a.negative_ : b_negative;
  take_magnitude(out.limbs_, a_is_larger ? b.limbs_ : a.limbs_);
  out.trim();
  return out;
}

ExactInteger operator*(const ExactInteger& a, const ExactInteger& b) {
  ExactInteger out;
  if (a.limbs_.empty() || b.limbs_.empty()) return out;
  out.negative_ = a.negative_ != b.negative_;
  out.limbs_.assign(a.limbs_.size() + b.limbs_.size(), 0);
  for (std::size_t i = 0; i < a.limbs_.size(); ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < b.limbs_.size(); ++j) {
      carry += static_cast<std::uint64_t>(a.limbs_[i]) * b.limbs_[j] + out.limbs_[i + j];
      out.limbs_[i + j] = static_cast<ExactInteger::Limb>(carry);
      carry >>= limb_bits;
    }
    out.limbs_[i + b.limbs_.size()] = static_cast<ExactInteger::Limb>(carry);
  }
  out.trim();
  return out;
}

double ExactInteger::rounded_ratio(const ExactInteger& numerator, const ExactInteger& denominator, int exponent) {
  if (numerator.limbs_.empty()) return 0;
  // The quotient has 55 or 56 bits. One more bit below them is 1 if the division leaves a remainder.
  constexpr int quotient_bits = 56;
  const int shift = quotient_bits - 1 - (static_cast<int>(numerator.bits()) - static_cast<int>(denominator.bits()));
  ExactInteger rest = numerator;
  rest.negative_ = false;
  if (shift > 0) rest = rest << static_cast<std::size_t>(shift);
  ExactInteger part = denominator << static_cast<std::size_t>(quotient_bits - (shift < 0 ? shift : 0));
  std::uint64_t quotient = 0;
  for (int k = 0; k < quotient_bits; ++k) {
    part.halve();
    quotient <<= 1;
    if (compare_magnitudes(rest, part) < 0) continue;
    take_magnitude(rest.limbs_, part.limbs_);
    rest.trim();
    quotient |= 1;
  }
  quotient = (quotient << 1) | (rest.limbs_.empty() ? 0 : 1);
  const double value = std::ldexp(static_cast<double>(quotient), exponent - shift - 1);
  return numerator.negative_ ? -value : value;
}

}  // namespace blum::detail
