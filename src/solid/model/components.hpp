// Blum: components of a solid in a square and in a cube. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/function_ref.hpp"
#include "blum/core/union_find.hpp"

namespace blum::detail {

/// Finds the components of a solid in a rectangle from their boundaries. A boundary consists of intervals, the parts of
/// the rectangle's border in the solid, and of arcs of the surface. An object may be reused.
class SquareComponents {
 public:
  void start(std::size_t intervals) {
    intervals_ = intervals;
    corners_.clear();
    arcs_.clear();
  }
  /// Joins two intervals that meet at a corner.
  void join(std::size_t one, std::size_t other) {
    corners_.push_back({static_cast<std::uint32_t>(one), static_cast<std::uint32_t>(other)});
  }
  /// An end of an arc. If it is on the border, `id` is the interval that ends there. Otherwise `id` is any number that
  /// only this end and the end of the next arc have.
  struct End {
    bool on_border = false;
    std::uint32_t id = 0;
  };
  void add_arc(const End& one, const End& other) { arcs_.push_back({one, other}); }

  /// Numbers the components: first those with intervals, in the order of their first interval, then the others, in the
  /// order of their first arc.
  /// @param is_hole  is called with the arcs of a closed curve inside the rectangle. It returns true if the solid lies
  ///                 outside the curve.
  /// @return  true if no component has a hole.
  bool finish(FunctionRef<bool(std::span<const std::uint32_t>)> is_hole);

  [[nodiscard]] std::uint32_t count() const { return count_; }
  [[nodiscard]] std::uint32_t of_interval(std::size_t interval) const { return component_[interval]; }
  /// Returns the component of an arc. Arcs are numbered in the order of add_arc().
  [[nodiscard]] std::uint32_t of_arc(std::size_t arc) const { return component_[intervals_ + arc]; }

 private:
  using Pair = std::array<std::uint32_t, 2>;

  void join_arcs();

  std::size_t intervals_ = 0;
  std::vector<Pair> corners_;
  std::vector<std::array<End, 2>> arcs_;
  UnionFind joined_;
  std::vector<Pair> inner_ends_;  ///< (id, arc)
  std::vector<std::uint32_t> component_;
  std::vector<Pair> loops_;  ///< for arcs of closed curves: (first arc of the curve, arc)
  std::vector<std::uint32_t> loop_;
  std::uint32_t count_ = 0;
};

/// Finds the components of a solid in a cube, or in a box, from their boundaries. A boundary consists of parts, the
/// components of the solid in the faces of the cube, and of pieces of the surface inside the cube. An object may be
/// reused.
class CubeComponents {
 public:
  /// @param parts  number of parts in all faces.
  void start(std::size_t parts) {
    joined_.reset(parts);
    euler_.assign(parts, 1);
    pieces_.clear();
  }
  /// Joins two parts of adjacent faces that share an interval.
  void join_at_interval(std::size_t one, std::size_t other) {
    joined_.join(static_cast<std::uint32_t>(one), static_cast<std::uint32_t>(other));
    --euler_[one];
  }
  /// Adds a corner of the cube inside the solid. It must be added for only one of its parts.
  void add_corner(std::size_t part) { ++euler_[part]; }
  /// Adds an arc that separates a part from the outside, and the piece of the surface that contains the arc.
  void add_arc(std::uint32_t piece, std::size_t part) { pieces_.emplace_back(piece, static_cast<std::uint32_t>(part)); }

  /// Numbers the boundaries of the components in the order of their first part.
  /// @param euler_of  returns the Euler number of an open piece: vertices minus edges plus triangles.
  /// @return  true if each boundary is a sphere, so that each component is a ball.
  bool finish(FunctionRef<std::int64_t(std::uint32_t)> euler_of);

  [[nodiscard]] std::uint32_t count() const { return count_; }
  [[nodiscard]] std::uint32_t of_part(std::size_t part) const { return component_[part]; }

 private:
  UnionFind joined_;
  std::vector<std::int64_t> euler_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pieces_;  ///< (piece, part)
  std::vector<std::uint32_t> component_;
  std::uint32_t count_ = 0;
};

}  // namespace blum::detail
