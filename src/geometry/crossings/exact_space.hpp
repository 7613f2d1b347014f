// Blum: points where edges and planes of a mesh meet, exactly. SPDX-License-Identifier: Apache-2.0
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

/// A plane through three vertices, or through an edge (the first two) and along an axis.
struct Cut {
  std::array<PointId, 3> corners{};
  int axis = -1;  ///< of a plane along an axis
};

/// The vertices of a mesh and the points that are made from them, with exact predicates. Coordinates of points are
/// quotients of whole numbers; each is also known rounded to the nearest double, which decides nearly always.
class ExactSpace {
 public:
  /// @param vertices  of magnitude 2 at most. Those at one place must not both be used. They must stay.
  /// @param used      those that points are made from.
  /// @throws std::range_error where one of their coordinates has more than `most_bits` bits behind the point.
  ExactSpace(std::span<const Vec3d> vertices, std::span<const PointId> used);

  /// Products of three coordinates are then exact in double precision, too.
  static constexpr int most_bits = 318;

  /// Vertices, then made points, without corners().
  [[nodiscard]] std::size_t size() const { return vertices_.size() + made_.size(); }
  [[nodiscard]] bool is_vertex(PointId p) const { return p < vertices_.size(); }
  /// To the nearest double in each coordinate.
  [[nodiscard]] const Vec3d& rounded(PointId p) const {
    return is_vertex(p) ? vertices_[p] : made_[p - vertices_.size()].rounded;
  }
  /// The order of two points along an axis: -1, 0, 1.
  [[nodiscard]] int compare(PointId a, PointId b, std::size_t axis) const;
  /// The order of two points of a line.
  [[nodiscard]] int compare(PointId a, PointId b) const;

  /// The side of a plane that a point lies on; of one through vertices as orient3d() counts sides.
  [[nodiscard]] int side(const Cut& cut, PointId p) const;
  /// Whether three points turn counter-clockwise (1), seen against an axis.
  [[nodiscard]] int turn(std::size_t axis, PointId a, PointId b, PointId c) const;

  /// Where an edge between vertices on both sides of a plane meets it.
  [[nodiscard]] PointId meet(PointId from, PointId to, const Cut& cut);
  /// The common point of three planes, which must have just one.
  [[nodiscard]] PointId meet(const Cut& a, const Cut& b, const Cut& c);
  /// Three points across an axis, which turn counter-clockwise around all others seen against it.
  [[nodiscard]] std::array<PointId, 3> corners_around(std::size_t axis);

 private:
  struct Exact {
    std::array<ExactInteger, 3> at;
    ExactInteger weight;  ///< > 0: that coordinates are divided by
  };
  struct Made {
    Exact exact;
    Vec3d rounded;
    std::optional<PointId> next;  ///< with the same rounded coordinates
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
  int shift_ = 0;  ///< whole numbers are coordinates times two to this power
  std::vector<Made> made_;
  std::unordered_map<std::array<std::uint64_t, 3>, PointId, PlaceHash> at_place_;
  mutable std::unordered_map<PointId, Exact> of_vertex_;
};

}  // namespace blum::detail
