// Blum: half-spaces below the distances from planes, with exact signs. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/core/vec3.hpp"
#include "exact/integer.hpp"
#include "voronoi/planes/root_sum.hpp"

namespace blum::voronoi {

using detail::Integer;

/// A plane in integers: the points x with normal . x + offset = 0.
struct IntegerPlane {
  std::array<Integer, 3> normal;
  Integer offset;
};

/// Vertex of a polytope of half-spaces, in mesh units relative to the origin of the HalfSpaces.
struct PlacedCorner {
  Vec3d at;
  double height = 0;
  double error = 0;  ///< bound on the error of each coordinate; infinite if none is known.
  /// How far the point moves at most if each half-space moves by 1; infinite if no bound is known.
  double condition = 0;
};

/// Half-spaces in space and height h: normal . x + offset >= weight * h. For a plane, the normal is a unit vector and
/// the weight 1. So its half-space contains the points (x, h) for which the plane's distance from x is at least h. The
/// floor h >= 0 and six half-spaces of a large box, with weight 0, follow the planes.
///
/// A base is a list of four half-spaces whose borders meet in one point.
class HalfSpaces {
 public:
  using Index = std::uint32_t;
  using Base = std::array<Index, 4>;

  /// @param planes  facing inwards, in units of `unit`, relative to the origin.
  /// @param reach   a bound on the coordinates of all vertices, in the same units.
  /// @param unit    a power of two, mesh units.
  HalfSpaces(const std::vector<IntegerPlane>& planes, const Integer& reach, double unit);

  [[nodiscard]] Index plane_count() const { return count_; }
  [[nodiscard]] Index floor() const { return count_; }
  [[nodiscard]] Index box_side(Index k) const { return count_ + 1 + k; }
  [[nodiscard]] Index size() const { return static_cast<Index>(rows_.size()); }
  [[nodiscard]] const Vec3d& normal(Index k) const { return rows_[k].normal; }
  [[nodiscard]] double offset(Index k) const { return rows_[k].offset; }

  /// Returns the point of a base in double, with a bound on its error.
  [[nodiscard]] PlacedCorner place(const Base& base) const;
  /// Returns the point of a base, rounded once.
  [[nodiscard]] PlacedCorner place_exactly(const Base& base) const;
  /// Returns 1, 0 or -1: the point of a base is inside a half-space, on its border or outside. Exact.
  /// @param placed  the result of place().
  [[nodiscard]] int side(const Base& base, const PlacedCorner& placed, Index of) const;

 private:
  struct Row {
    Vec3d normal;
    double offset = 0, weight = 0;
  };
  struct ExactRow {
    IntegerPlane plane;
    int weight = 0;  ///< sign of the weight
    Root root;       ///< magnitude of the weight, for the integer normal
  };

  void add(IntegerPlane plane, int weight);
  [[nodiscard]] int exact_side(const Base& base, Index of) const;

  Index count_ = 0;
  int exponent_ = 0;  ///< of the unit, a power of two
  double size_ = 0;
  std::vector<Row> rows_;
  std::vector<ExactRow> exact_;
};

}  // namespace blum::voronoi
