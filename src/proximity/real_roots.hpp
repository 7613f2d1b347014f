// Blum: the roots of a polynomial between 0 and 1, exactly. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "proximity/polynomial.hpp"

namespace blum::detail {

/// A root: cell / 2^depth where it is exact, else the only one between this and (cell + 1) / 2^depth, which are none.
struct RealRoot {
  Integer cell = 0;
  unsigned depth = 0;
  bool is_exact = false;

  [[nodiscard]] Dyadic low() const { return {cell, depth}; }
  [[nodiscard]] Dyadic high() const { return {cell + 1, depth}; }
  /// A number that is no more than the root, and less by 2^-52 at most besides the width of the interval.
  [[nodiscard]] double lower_bound() const;
};

/// The real roots of a polynomial in [0, 1], and the signs of others there. All answers are exact.
/// Method: counts of roots by sequences of remainders (Sturm 1829; of those with a sign condition: Tarski 1951).
class RealRoots {
 public:
  /// @param polynomial  not zero.
  explicit RealRoots(Polynomial polynomial);

  /// The roots, each once, by rising value.
  [[nodiscard]] const std::vector<RealRoot>& all() const { return roots_; }

  /// The same root in an interval no wider than 2^-depth.
  [[nodiscard]] RealRoot refined(RealRoot root, unsigned depth) const;

  /// -1, 0 or 1: that of another polynomial at a root.
  [[nodiscard]] int sign_at(const RealRoot& root, const Polynomial& other) const;

 private:
  void isolate();
  void separate();
  [[nodiscard]] RealRoot guessed(const RealRoot& root, int low_sign, unsigned depth) const;
  [[nodiscard]] static int sign_over(const RealRoot& root, const Polynomial& other);

  Polynomial rest_;  ///< without the roots that were met exactly
  std::vector<Polynomial> sequence_;
  std::vector<RealRoot> roots_;
};

}  // namespace blum::detail
