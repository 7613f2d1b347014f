#include "voronoi/planes/root_sum.hpp"

#include <cstddef>
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
    sum += term.factor * term.root->times_power(bits);
    error += abs(term.factor);
  }
  if (abs(sum) > error) return sign_of(sum);
  return std::nullopt;
}

/// Returns sqrt(a * b) if it is an integer.
std::optional<Integer> common_root(const Integer& a, const Integer& b) {
  if (a == b) return a;
  const Integer product = a * b;
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
  for (std::size_t k = 0; k < stored_bits.size(); ++k)
    stored_[k] = sqrt(detail::times_power(square_, 2 * stored_bits[k]));
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
