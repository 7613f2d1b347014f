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

/// Number of a point: a vertex of a mesh, or a point constructed from its edges and planes. Equal points have equal
/// numbers.
using PointId = std::uint32_t;

/// Plane through three vertices, or through two vertices and parallel to an axis.
struct Cut {
  std::array<PointId, 3> corners{};
  int axis = -1;  ///< axis to which the plane is parallel; -1 for a plane through three vertices
};

/// Vertices of a mesh and points constructed from them, with exact predicates. Coordinates of points are quotients of
/// integers. Coordinates are also stored rounded to the nearest double, which decides nearly all predicates.
class ExactSpace {
 public:
  /// @param vertices  coordinates of magnitude at most 2. The coordinates must outlive this object. Used vertices must
  /// have different positions.
  /// @param used      vertices from which points are constructed.
  /// @throws std::range_error if a coordinate of a used vertex has more than `most_bits` fractional bits.
  ExactSpace(std::span<const Vec3d> vertices, std::span<const PointId> used);

  /// If coordinates have at most this many fractional bits, products of three coordinates are exact as sums of doubles.
  static constexpr int most_bits = 318;

  /// Returns the number of vertices and constructed points, including those of corners_around().
  [[nodiscard]] std::size_t size() const { return vertices_.size() + made_.size(); }
  [[nodiscard]] bool is_vertex(PointId p) const { return p < vertices_.size(); }
  /// Returns a point with each coordinate rounded to the nearest double.
  [[nodiscard]] const Vec3d& rounded(PointId p) const {
    return is_vertex(p) ? vertices_[p] : made_[p - vertices_.size()].rounded;
  }
  /// Compares the coordinates of two points along an axis. Returns -1, 0 or 1.
  [[nodiscard]] int compare(PointId a, PointId b, std::size_t axis) const;
  /// Compares two points of one line by their order on it. Returns -1, 0 or 1.
  [[nodiscard]] int compare(PointId a, PointId b) const;

  /// Returns the side of a plane on which a point lies: -1, 0 or 1. For planes through three vertices, the sign is that
  /// of orient3d().
  [[nodiscard]] int side(const Cut& cut, PointId p) const;
  /// Returns 1 if three points turn counter-clockwise seen against an axis, -1 if clockwise, else 0.
  [[nodiscard]] int turn(std::size_t axis, PointId a, PointId b, PointId c) const;

  /// Returns the point where a plane meets an edge. The edge's ends must be vertices on different sides of the plane.
  [[nodiscard]] PointId meet(PointId from, PointId to, const Cut& cut);
  /// Returns the common point of three planes, which must be unique.
  [[nodiscard]] PointId meet(const Cut& a, const Cut& b, const Cut& c);
  /// Returns three points in a plane perpendicular to an axis. Seen against the axis, they form a counter-clockwise
  /// triangle around all other points.
  [[nodiscard]] std::array<PointId, 3> corners_around(std::size_t axis);

 private:
  struct Exact {
    std::array<ExactInteger, 3> at;
    ExactInteger weight;  ///< common divisor of the coordinates, > 0
  };
  struct Made {
    Exact exact;
    Vec3d rounded;
    std::optional<PointId> next;  ///< next point with the same rounded coordinates
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
  int shift_ = 0;  ///< integers are coordinates times 2^shift_
  std::vector<Made> made_;
  std::unordered_map<std::array<std::uint64_t, 3>, PointId, PlaceHash> at_place_;
  mutable std::unordered_map<PointId, Exact> of_vertex_;
};

}  // namespace blum::detail
