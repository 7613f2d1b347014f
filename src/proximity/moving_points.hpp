// Blum: moving points with integer coordinates. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "blum/proximity/impact.hpp"
#include "proximity/polynomial.hpp"

namespace blum::detail {

/// start + slope * t.
struct Linear {
  Integer start;
  Integer slope;
};

using MovingVector = std::array<Linear, 3>;

/// Positions over time, and a distance, scaled by one power of two such that all are integers.
struct IntegerPoints {
  std::array<MovingVector, 4> at;
  Integer distance;
};
[[nodiscard]] IntegerPoints integer_points(const FourMovingPoints& points, double distance = 0);

[[nodiscard]] MovingVector operator-(const MovingVector& a, const MovingVector& b);
[[nodiscard]] Polynomial operator*(const Linear& a, const Linear& b);

/// One component of a cross product.
[[nodiscard]] Polynomial cross_component(const MovingVector& a, const MovingVector& b, std::size_t axis);
[[nodiscard]] Polynomial dot(const MovingVector& a, const MovingVector& b);

using PolynomialVector = std::array<Polynomial, 3>;
[[nodiscard]] PolynomialVector cross(const MovingVector& a, const MovingVector& b);
[[nodiscard]] Polynomial dot(const PolynomialVector& a, const PolynomialVector& b);
[[nodiscard]] Polynomial dot(const PolynomialVector& a, const MovingVector& b);

/// The depth at which intervals are no wider than a tolerance, from 2^-40 to 1.
[[nodiscard]] unsigned depth_of(double tolerance);

}  // namespace blum::detail
