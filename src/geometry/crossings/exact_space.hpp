// Blum: exact points where edges and planes of a mesh meet. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "blum/core/vec3.hpp"
#include "exact/exact_integer.hpp"

namespace blum::detail {

/// A vertex of a mesh, or a point made from its edges and planes. Equal points have equal numbers.
using PointId = std::uint32_t;

/// A plane through three vertices, or one through an edge (the first two) and along an axis.
struct Cut {
  std::array<PointId, 3> corners{};
  int axis = -1;  ///< of a plane along an axis, else -1
};

/// The vertices of a mesh and points made from them, with exact predicates. Coordinates of points are quotients of
/// integers. Each point is also known rounded to the nearest double, which decides nearly all predicates.
class ExactSpace {
 public:
  /// @param vertices  of magnitude 2 at most. They must outlive this object. At most one vertex at each place may be
  /// used.
  /// @param used      vertices that points are made from.
  /// @throws std::range_error if a coordinate of a used vertex has more than `most_bits` fractional bits.
  ExactSpace(std::span<const Vec3d> vertices, std::span<const PointId> used);

  /// With at most this many, products of three coordinates are also exact as sums of doubles.
  static constexpr int most_bits = 318;

  /// Returns the number of vertices and made points, including those of corners_around().
  [[nodiscard]] std::size_t size() const { return vertices_.size() + made_.size(); }
  [[nodiscard]] bool is_vertex(PointId p) const { return p < vertices_.size(); }
  /// Returns the point with each coordinate rounded to the nearest double.
  [[nodiscard]] const Vec3d& rounded(PointId p) const {
    return is_vertex(p) ? vertices_[p] : made_[p - vertices_.size()].rounded;
  }
  /// Compares two points along an axis. Returns -1, 0 or 1.
  [[nodiscard]] int compare(PointId a, PointId b, std::size_t axis) const;
  /// Compares two points along their common line. Returns -1, 0 or 1.
  [[nodiscard]] int compare(PointId a, PointId b) const;

  /// Returns the side of a plane on which a point lies. For planes through three vertices, the sign is that of
  /// orient3d().
  [[nodiscard]] int side(const Cut& cut, PointId p) const;
  /// Returns 1 if three points turn counter-clockwise seen against an axis, -1 if clockwise, else 0.
  [[nodiscard]] int turn(std::size_t axis, PointId a, PointId b, PointId c) const;

  /// Returns the point where a plane meets an edge between vertices on both sides of it.
  [[nodiscard]] PointId meet(PointId from, PointId to, const Cut& cut);
  /// Returns the common point of three planes, which must be unique.
  [[nodiscard]] PointId meet(const Cut& a, const Cut& b, const Cut& c);
  /// Returns three points in a plane across an axis. They turn counter-clockwise around all others, seen against the
  /// axis.
  [[nodiscard]] std::array<PointId, 3> corners_around(std::size_t axis);

 private:
  struct Exact {
    std::array<ExactInteger, 3> at;
    ExactInteger weight;  ///< > 0: divisor of the coordinates
  };
  struct Made {
    Exact exact;
    Vec3d rounded;
    std::optional<PointId> next;  ///< point with the same rounded coordinates
  };
  struct Plane {
    std::array<ExactInteger, 3> normal;
    ExactInteger offset;
  };
  struct PlaceHash {
    std::size_t operator()(const std::array<std::uint64_t, 3>& key) const;
  };

  [[nodiscard]] ExactInteger whole(double coordinate) const;
  [[nodiscard]] const Exact& exact(PointId p) const;
  [[nodiscard]] Plane plane(const Cut& cut) const;
  static ExactInteger height(const Plane& plane, const Exact& p);
  [[nodiscard]] std::optional<int> filtered_side(const Cut& cut, const Vec3d& p) const;
  [[nodiscard]] std::optional<int> filtered_turn(std::size_t axis, PointId a, PointId b, PointId c) const;
  PointId add(Exact exact);

  std::span<const Vec3d> vertices_;
  int shift_ = 0;  ///< integers are coordinates times two to this power
  std::vector<Made> made_;
  std::unordered_map<std::array<std::uint64_t, 3>, PointId, PlaceHash> at_place_;
  mutable std::unordered_map<PointId, Exact> of_vertex_;
};

}  // namespace blum::detail
