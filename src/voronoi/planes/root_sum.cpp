#include "voronoi/planes/root_sum.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace blum::voronoi {
namespace {

using detail::Integer;

int sign_of(const Integer& value) {
  return value.sign();
}

/// Returns the sign of the sum if rounded roots decide it.
std::optional<int> sign_with_bits(std::span<const RootTerm> terms, int bits) {
  Integer sum = 0;
  Integer error = 0;
  for (const RootTerm& term : terms) {
    if (term.factor.is_zero()) continue;
    sum += term.factor * term.root->times_power(bits);
    error += abs(term.factor);
  }
  if (error.is_zero() || abs(sum) > error) return sign_of(sum);
  return std::nullopt;
}

template <std::uint32_t modulus>
bool is_square_in(std::uint32_t value) {
  static constexpr auto squares = [] {
    std::array<bool, modulus> out{};
    for (std::uint32_t k = 0; k < modulus; ++k) out[k * k % modulus] = true;
    return out;
  }();
  return squares[value % modulus];
}

/// Returns false for most integers that are not squares.
bool may_be_square(const Integer& value) {
  constexpr std::uint32_t product = 64 * 63 * 65 * 11;
  const auto rest = static_cast<std::uint32_t>(Integer(value % product));
  return is_square_in<64>(rest) && is_square_in<63>(rest) && is_square_in<65>(rest) && is_square_in<11>(rest);
}

/// Returns sqrt(a * b) if it is an integer.
std::optional<Integer> common_root(const Integer& a, const Integer& b) {
  if (a == b) return a;
  const Integer product = a * b;
  if (!may_be_square(product)) return std::nullopt;
  Integer root = sqrt(product);
  if (root * root != product) return std::nullopt;
  return root;
}

/// Returns true if the sum is 0: for each group of roots with rational ratios, the joined factor is 0.
bool is_zero(std::span<const RootTerm> terms) {
  std::vector<bool> is_joined(terms.size(), false);
  for (std::size_t k = 0; k < terms.size(); ++k) {
    if (is_joined[k] || terms[k].factor.is_zero()) continue;
    const Integer& square = terms[k].root->square();
    // The factor of the root of `square`, times `square`.
    Integer factor = terms[k].factor * square;
    for (std::size_t m = k + 1; m < terms.size(); ++m) {
      if (is_joined[m]) continue;
      const std::optional<Integer> root = common_root(square, terms[m].root->square());
      if (!root) continue;
      is_joined[m] = true;
      factor += terms[m].factor * *root;
    }
    if (!factor.is_zero()) return false;
  }
  return true;
}

}  // namespace

Root::Root(detail::Integer square) : square_(std::move(square)) {
  stored_.back() = sqrt(detail::times_power(square_, 2 * stored_bits.back()));
  // Rounded down twice is rounded down once.
  for (std::size_t k = 0; k + 1 < stored_bits.size(); ++k) {
    stored_[k] = stored_.back() / detail::times_power(1, stored_bits.back() - stored_bits[k]);
  }
}

detail::Integer Root::times_power(int bits) const {
  for (std::size_t k = 0; k < stored_bits.size(); ++k) {
    if (stored_bits[k] == bits) return stored_[k];
  }
  return sqrt(detail::times_power(square_, 2 * bits));
}

int sign_of_root_sum(std::span<const RootTerm> terms) {
  for (const int bits : Root::stored_bits) {
    if (const std::optional<int> sign = sign_with_bits(terms, bits)) return *sign;
  }
  if (is_zero(terms)) return 0;
  for (int bits = 4 * Root::stored_bits.back();; bits *= 2) {
    if (const std::optional<int> sign = sign_with_bits(terms, bits)) return *sign;
  }
}

}  // namespace blum::voronoi
