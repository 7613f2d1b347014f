// Blum: exact signs of sums of square roots. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "exact/integer.hpp"

namespace blum::voronoi {

/// The square root of an integer >= 0, rounded down at several precisions.
class Root {
 public:
  Root() = default;
  explicit Root(detail::Integer square);

  [[nodiscard]] const detail::Integer& square() const { return square_; }
  /// Returns the largest integer whose value is at most 2^bits times the root.
  [[nodiscard]] detail::Integer times_power(int bits) const;

  static constexpr std::array<int, 2> stored_bits{64, 256};

 private:
  detail::Integer square_ = 0;
  std::array<detail::Integer, 2> stored_{0, 0};  ///< times_power() of stored_bits
};

/// A term of a sum: factor * root.
struct RootTerm {
  detail::Integer factor = 0;
  const Root* root = nullptr;
};

/// Returns the sign of the sum of the terms, exactly: -1, 0 or 1.
///
/// Sums of rounded roots decide, with 64 and then 256 bits. If they do not, terms whose roots have a rational ratio are
/// joined. Square roots of integers are linearly independent over the rational numbers if no ratio of two of them is
/// rational (Besicovitch 1940). So the sum is 0 only if every joined factor is 0. Otherwise, more bits decide.
[[nodiscard]] int sign_of_root_sum(std::span<const RootTerm> terms);

}  // namespace blum::voronoi
