// Blum: triangles cut along their intersections. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "geometry/crossings/exact_space.hpp"

namespace blum::detail {

/// Triangle projected along an axis.
struct FlatTriangle {
  std::array<PointId, 3> corners{};
  std::size_t axis = 0;
  int turn = 0;  ///< orientation seen against the axis: 1 counter-clockwise, -1 clockwise, 0 without area

  [[nodiscard]] Cut plane() const { return {corners, -1}; }
};

[[nodiscard]] FlatTriangle seen_along(const ExactSpace& space, const Triangle& triangle, std::size_t axis);
/// Returns the triangle projected along the axis closest to its normal.
[[nodiscard]] FlatTriangle flattened(const ExactSpace& space, const Triangle& triangle);

/// Returns true if a point in a triangle's plane lies in the triangle or on its border.
[[nodiscard]] bool contains(const ExactSpace& space, const FlatTriangle& triangle, PointId p);

/// Points on edges, without the ends, where the edges must be cut.
class EdgePoints {
 public:
  /// Adds a point to an edge. Returns true if it is new. If it is an end of the edge, does nothing.
  bool add(PointId from, PointId to, PointId p);
  [[nodiscard]] std::span<const PointId> of(PointId from, PointId to) const;
  [[nodiscard]] bool empty() const { return of_edge_.empty(); }

 private:
  static std::uint64_t key(PointId from, PointId to);

  std::unordered_map<std::uint64_t, std::vector<PointId>> of_edge_;
};

/// Common points of two triangles.
struct Contact3 {
  bool is_coplanar = false;  ///< true if both lie in one plane; the other members are then not set
  std::size_t count = 0;     ///< number of points: 0 nothing in common, 1 a point, 2 a segment
  std::array<PointId, 2> points{};
};

/// Returns the common points of two triangles. Adds to `edge_points` the common points that lie on an edge of either
/// triangle, without its ends.
[[nodiscard]] Contact3 contact_of(ExactSpace& space, const FlatTriangle& a, const FlatTriangle& b,
                                  EdgePoints& edge_points);

/// Error with the reason why crossings cannot be resolved.
class Unresolved : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Part of an input triangle, or a whole input triangle.
struct Facet {
  std::array<PointId, 3> corners{};
  /// Multiplicity, > 0: number of input triangles here with this direction, minus the number with the opposite
  /// direction.
  std::int32_t times = 1;
  std::uint32_t source = 0;  ///< input triangle that contains the facet and has its orientation
  std::uint32_t sheet = 0;   ///< facets with equal numbers lie in one plane and were cut together
};

/// Triangles of a welded mesh, and the pairs that cross or touch.
struct CrossedMesh {
  std::span<const Vec3d> vertices;  ///< coordinates of magnitude at most 2
  std::span<const Triangle> triangles;
  /// Per triangle: 0 if it has an area, 1 if its corners are collinear, 2 if it has at most two distinct corners.
  std::span<const std::uint8_t> is_flat;
  std::span<const TrianglePair> pairs;
};

struct CutMesh {
  ExactSpace space;
  std::vector<Facet> facets = {};
  std::vector<std::uint32_t> sheet_of = {};  ///< sheet of each input triangle
  /// Number of input triangles that were cut: triangles in pairs, and triangles with cut edges.
  std::size_t cut = 0;
};

/// Cuts the triangles that cross or touch others. In the result, two facets share only vertices and edges of both.
/// Triangles that overlap in a plane become one set of facets. Other triangles are not cut, and triangles without area
/// are removed. The mesh must outlive the result.
/// @throws Unresolved, Cancelled.
[[nodiscard]] CutMesh cut_triangles(const CrossedMesh& mesh, const Context& context);

}  // namespace blum::detail
