// Blum: triangulation of points in a plane, with given segments. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <unordered_map>
#include <vector>

#include "geometry/crossings/exact_space.hpp"

namespace blum::detail {

/// Triangulation of a large outer triangle. Inserted points are corners of its triangles, and inserted segments are
/// edges. Triangles are counter-clockwise, seen against an axis. Orientations of points are exact. Large angles are
/// preferred, but not guaranteed. Method: points are inserted one by one. Segments are inserted by flipping the edges
/// that cross them (Sloan 1993).
class PlanarMesh {
 public:
  /// @param outer  three points whose triangle contains all other points.
  PlanarMesh(const ExactSpace& space, std::size_t axis, const std::array<PointId, 3>& outer);

  /// Inserts a point.
  /// @return  false if another point is at the same position.
  [[nodiscard]] bool insert(PointId point);
  /// Makes a segment a fixed edge. No point may lie on it, and no fixed edge may cross it. The ends of the segment must
  /// have been inserted.
  /// @return  false if a point lies on the segment, or a fixed edge crosses it.
  [[nodiscard]] bool insert_segment(PointId from_point, PointId to_point);
  /// Flips edges to enlarge the smallest angles, as far as rounding allows.
  void improve();

  /// Returns the triangles that have no outer point as a corner.
  [[nodiscard]] std::vector<std::array<PointId, 3>> triangles() const;

 private:
  using Index = std::uint32_t;
  static constexpr Index none = 0xffffffffU;

  struct Corners {
    std::array<Index, 3> at{};
    std::array<Index, 3> beyond{none, none, none};  ///< triangle beyond the edge from corner k to the next corner
    std::array<bool, 3> stays{};
  };
  struct Edge {
    Index triangle = none;
    std::size_t k = 0;
  };

  [[nodiscard]] int turn(Index a, Index b, Index c) const {
    return space_.turn(axis_, points_[a], points_[b], points_[c]);
  }
  void set(Index triangle, const Corners& corners);
  void replace(Index triangle, Index old_neighbour, Index new_neighbour);
  [[nodiscard]] std::size_t edge_towards(Index own, Index neighbour) const;
  [[nodiscard]] std::optional<Index> locate(Index p, std::array<int, 3>& turns) const;
  void split_triangle(Index triangle, Index p);
  void split_edge(Index triangle, std::size_t k, Index p);
  [[nodiscard]] std::optional<Edge> edge_between(Index from, Index to) const;
  [[nodiscard]] bool is_convex(const Edge& edge) const;
  void flip(const Edge& edge);
  [[nodiscard]] bool wants_flip(const Edge& edge) const;
  [[nodiscard]] std::optional<std::deque<std::array<Index, 2>>> crossed_by(Index from, Index to) const;
  /// Calls visit(triangle, index k of the corner) for the triangles around a corner, until a call returns true. Returns
  /// true if a call returned true.
  template <class Visit>
  bool around(Index corner, const Visit& visit) const;

  const ExactSpace& space_;
  std::size_t axis_;
  std::vector<PointId> points_;
  std::vector<Index> triangle_at_;  ///< for each point: some triangle with this corner
  std::vector<Corners> triangles_;
  std::unordered_map<PointId, Index> index_;
  Index last_ = 0;
};

}  // namespace blum::detail
