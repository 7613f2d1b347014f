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

/// Finds the components of a solid in a rectangle from their boundaries. These are the parts of the rectangle's border
/// in the solid, called intervals, and arcs of the surface. Reusable.
class SquareComponents {
 public:
  void start(std::size_t intervals) {
    intervals_ = intervals;
    corners_.clear();
    arcs_.clear();
  }
  /// Joins two intervals that meet in a corner.
  void join(std::size_t one, std::size_t other) {
    corners_.push_back({static_cast<std::uint32_t>(one), static_cast<std::uint32_t>(other)});
  }
  /// An end of an arc. On the border, the id is the interval that ends there. Else it is an id that the end shares with
  /// the end of the next arc.
  struct End {
    bool on_border = false;
    std::uint32_t id = 0;
  };
  void add_arc(const End& one, const End& other) { arcs_.push_back({one, other}); }

  /// Numbers the components by their first interval, then those without intervals by their first arc.
  /// @param is_hole  called with the arcs of a closed curve without intervals; returns true if the solid is outside it.
  /// @return  true if no component has a hole.
  bool finish(FunctionRef<bool(std::span<const std::uint32_t>)> is_hole);

  [[nodiscard]] std::uint32_t count() const { return count_; }
  [[nodiscard]] std::uint32_t of_interval(std::size_t interval) const { return component_[interval]; }
  /// Returns the component of an arc, numbered in the order of add_arc().
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
  std::vector<Pair> loops_;  ///< (first arc, arc) of closed curves
  std::vector<std::uint32_t> loop_;
  std::uint32_t count_ = 0;
};

/// Finds the components of a solid in a cube, or in a box, from their boundaries. These are the components in its
/// sides, called parts, and pieces of the surface inside. Reusable.
class CubeComponents {
 public:
  /// @param parts  number of components in the sides.
  void start(std::size_t parts) {
    joined_.reset(parts);
    euler_.assign(parts, 1);
    pieces_.clear();
  }
  /// Joins two parts that share an interval.
  void join_at_interval(std::size_t one, std::size_t other) {
    joined_.join(static_cast<std::uint32_t>(one), static_cast<std::uint32_t>(other));
    --euler_[one];
  }
  /// Adds a corner of the cube that is inside, and belongs to this part and others.
  void add_corner(std::size_t part) { ++euler_[part]; }
  /// Adds an arc that a part has on a piece of the surface.
  void add_arc(std::uint32_t piece, std::size_t part) { pieces_.emplace_back(piece, static_cast<std::uint32_t>(part)); }

  /// Numbers the boundaries of the components by their first part.
  /// @param euler_of  returns the Euler number of an open piece.
  /// @return  true if each of them is a sphere, so that each component is a ball.
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
