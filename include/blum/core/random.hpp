// Blum: a small random generator with the same numbers everywhere. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "blum/core/vec3.hpp"

namespace blum {

/// SplitMix64 generator (Steele, Lea, Flood 2014). The distributions of this class are the same everywhere, while those
/// of the standard library differ between implementations. So generated shapes and tests are the same on every
/// platform.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// Returns 64 random bits.
  [[nodiscard]] std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// Returns a number that is uniform in [0, 1), with 53 random bits.
  [[nodiscard]] double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  /// Returns a number that is uniform in [lower, upper).
  [[nodiscard]] double uniform(double lower, double upper) { return lower + (upper - lower) * uniform(); }
  /// Returns a whole number that is uniform in {0, ..., count - 1}; count must be above 0. The bias is below
  /// count / 2^53.
  [[nodiscard]] std::uint64_t below(std::uint64_t count) {
    return static_cast<std::uint64_t>(uniform() * static_cast<double>(count));
  }
  /// Returns a point that is uniform in the cube [0, 1)^3.
  [[nodiscard]] Vec3d in_cube() {
    const double x = uniform();
    const double y = uniform();
    return {x, y, uniform()};
  }
  /// Returns a point that is uniform in the unit ball, by rejection.
  [[nodiscard]] Vec3d in_ball() {
    while (true) {
      const Vec3d p = in_cube() * 2.0 - Vec3d{1, 1, 1};
      if (squared_length(p) <= 1) return p;
    }
  }

 private:
  std::uint64_t state_;
};

}  // namespace blum
