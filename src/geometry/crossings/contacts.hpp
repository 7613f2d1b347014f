// Blum: the points and segments in which triangles meet. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "blum/geometry/triangle_mesh.hpp"
#include "geometry/crossings/exact_space.hpp"

namespace blum::detail {

/// What a triangle looks like against an axis.
struct FlatTriangle {
  std::array<PointId, 3> corners{};
  std::size_t axis = 0;
  int turn = 0;  ///< 1 where it turns counter-clockwise seen against the axis, -1 where clockwise; 0 without area

  [[nodiscard]] Cut plane() const { return {corners, -1}; }
};

[[nodiscard]] FlatTriangle seen_along(const ExactSpace& space, const Triangle& triangle, std::size_t axis);
/// Along the axis that it is not parallel to most.
[[nodiscard]] FlatTriangle flattened(const ExactSpace& space, const Triangle& triangle);

/// Whether a point of a triangle's plane lies in it, its border included.
[[nodiscard]] bool contains(const ExactSpace& space, const FlatTriangle& triangle, PointId p);

/// Points inside of edges: where these are to be cut.
class EdgePoints {
 public:
  /// Whether it was not there before. The ends of an edge are not taken.
  bool add(PointId from, PointId to, PointId p);
  [[nodiscard]] std::span<const PointId> of(PointId from, PointId to) const;
  [[nodiscard]] bool empty() const { return of_edge_.empty(); }

 private:
  static std::uint64_t key(PointId from, PointId to);

  std::unordered_map<std::uint64_t, std::vector<PointId>> of_edge_;
};

/// What two triangles have in common.
struct Contact3 {
  bool is_coplanar = false;  ///< then no more is told
  std::size_t count = 0;     ///< 0: nothing, 1: a point, 2: a segment
  std::array<PointId, 2> points{};
};

/// Points that lie inside of an edge of one of the two are added to `edge_points`.
[[nodiscard]] Contact3 contact_of(ExactSpace& space, const FlatTriangle& a, const FlatTriangle& b,
                                  EdgePoints& edge_points);

}  // namespace blum::detail
