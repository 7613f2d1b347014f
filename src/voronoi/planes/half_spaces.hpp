// Blum: half-spaces below the distances from planes, with exact signs. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "exact/double2.hpp"
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

/// A vertex in exact coordinates. Each one is a sum of integers times roots, divided by another such sum. The height's
/// numerator is an integer.
struct ExactCorner {
  struct Term {
    std::array<Integer, 3> at;  ///< factors of the root in x, y and z
    Integer all;                ///< its factor in the denominator
    const Root* root = nullptr;
  };
  std::array<Term, 4> terms;  ///< one for each half-space of the base; those after `count` are not used
  std::size_t count = 0;
  Integer height;
  int sign = 0;                           ///< of the denominator, not 0
  bool is_placed = false;                 ///< HalfSpaces::place() has set the rest
  std::array<detail::Double2, 4> placed;  ///< x, y, z and height, mesh units
  double error = 0;                       ///< bound on the error of each one of `placed`
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

  HalfSpaces() = default;
  /// @param planes  facing inwards, in units of `unit`, relative to the origin.
  /// @param reach   a bound on the coordinates of all vertices, in the same units.
  /// @param unit    a power of two, mesh units.
  /// @throws Cancelled.
  HalfSpaces(const std::vector<IntegerPlane>& planes, const Integer& reach, double unit, const Context& context);

  [[nodiscard]] Index plane_count() const { return count_; }
  [[nodiscard]] Index floor() const { return count_; }
  [[nodiscard]] Index box_side(Index k) const { return count_ + 1 + k; }
  [[nodiscard]] Index size() const { return static_cast<Index>(rows_.size()); }
  [[nodiscard]] const Vec3d& normal(Index k) const { return rows_[k].normal; }
  [[nodiscard]] double offset(Index k) const { return rows_[k].offset; }
  /// Returns a bound on the coordinates of the vertices, mesh units.
  [[nodiscard]] double size_bound() const { return size_; }

  /// Returns the point of a base in double, with a bound on its error.
  [[nodiscard]] PlacedCorner place(const Base& base) const;
  /// Returns the point of a base, exactly.
  [[nodiscard]] ExactCorner exact_corner(const Base& base) const;
  /// Sets the coordinates with twice the digits of a double, so that position() seldom needs exact numbers.
  void place(ExactCorner& corner) const;
  /// Returns the point of a base, rounded once.
  [[nodiscard]] PlacedCorner place_exactly(const Base& base) const;
  /// Returns the same for a placed corner. No bound on how far it moves is known.
  [[nodiscard]] static PlacedCorner rounded(const ExactCorner& corner);

  /// Returns how far a point is inside a half-space, rounded: negative outside, and 0 if double cannot decide it.
  [[nodiscard]] double depth(const PlacedCorner& placed, Index of) const;
  /// Position of a point relative to a half-space.
  struct Position {
    int side = 0;      ///< 1 inside, 0 on the border, -1 outside: exact
    double depth = 0;  ///< mesh units; 0 if the corner is not placed
  };
  [[nodiscard]] Position position(const ExactCorner& corner, Index of) const;

 private:
  struct Row {
    Vec3d normal;
    double offset = 0, weight = 0;
  };
  struct ExactRow {
    IntegerPlane plane;
    int weight = 0;                      ///< sign of the weight
    Root root;                           ///< magnitude of the weight, for the integer normal
    std::array<detail::Double2, 4> row;  ///< unit normal and offset, mesh units
  };

  void set(Index k, IntegerPlane plane, int weight);
  [[nodiscard]] static int exact_side(const ExactCorner& corner, const ExactRow& row);

  Index count_ = 0;
  int exponent_ = 0;  ///< of the unit, a power of two
  double size_ = 0;
  std::vector<Row> rows_;
  std::vector<ExactRow> exact_;
};

}  // namespace blum::voronoi
