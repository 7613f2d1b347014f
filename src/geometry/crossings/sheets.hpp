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

/// A triangle seen along an axis.
struct FlatTriangle {
  std::array<PointId, 3> corners{};
  std::size_t axis = 0;
  int turn = 0;  ///< seen against the axis: 1 counter-clockwise, -1 clockwise, 0 without area

  [[nodiscard]] Cut plane() const { return {corners, -1}; }
};

[[nodiscard]] FlatTriangle seen_along(const ExactSpace& space, const Triangle& triangle, std::size_t axis);
/// Returns the triangle seen along the axis closest to its normal.
[[nodiscard]] FlatTriangle flattened(const ExactSpace& space, const Triangle& triangle);

/// Returns true if a point in a triangle's plane lies in the triangle or on its border.
[[nodiscard]] bool contains(const ExactSpace& space, const FlatTriangle& triangle, PointId p);

/// Points inside edges, where the edges are to be cut.
class EdgePoints {
 public:
  /// Adds a point. Returns true if it is new; ends of the edge are ignored.
  bool add(PointId from, PointId to, PointId p);
  [[nodiscard]] std::span<const PointId> of(PointId from, PointId to) const;
  [[nodiscard]] bool empty() const { return of_edge_.empty(); }

 private:
  static std::uint64_t key(PointId from, PointId to);

  std::unordered_map<std::uint64_t, std::vector<PointId>> of_edge_;
};

/// The common points of two triangles.
struct Contact3 {
  bool is_coplanar = false;  ///< if true, the rest is not set
  std::size_t count = 0;     ///< 0: nothing, 1: a point, 2: a segment
  std::array<PointId, 2> points{};
};

/// Returns the common points of two triangles. Adds those inside an edge of either triangle to `edge_points`.
[[nodiscard]] Contact3 contact_of(ExactSpace& space, const FlatTriangle& a, const FlatTriangle& b,
                                  EdgePoints& edge_points);

/// Reason why crossings cannot be resolved.
class Unresolved : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A part of an input triangle, or a whole one.
struct Facet {
  std::array<PointId, 3> corners{};
  std::int32_t times = 1;    ///< multiplicity in the input, minus that of triangles facing the other way; > 0
  std::uint32_t source = 0;  ///< input triangle in which it lies and as which it faces
  std::uint32_t sheet = 0;   ///< equal for facets in one plane that were cut together
};

/// Triangles of a welded mesh, and pairs of them that cross or touch.
struct CrossedMesh {
  std::span<const Vec3d> vertices;  ///< of magnitude 2 at most
  std::span<const Triangle> triangles;
  std::span<const std::uint8_t> is_flat;  ///< 0, or 1: collinear corners, 2: at most two distinct corners
  std::span<const TrianglePair> pairs;
};

struct CutMesh {
  ExactSpace space;
  std::vector<Facet> facets = {};
  std::vector<std::uint32_t> sheet_of = {};  ///< of each input triangle
  std::size_t cut = 0;                       ///< input triangles that were cut: those in pairs or at cut edges
};

/// Cuts the triangles that cross or touch others, so that any two share only edges and corners of both. Triangles that
/// overlap in a plane become one set of facets. Other triangles are kept whole, and flat ones are removed. The mesh
/// must outlive the result.
/// @throws Unresolved, Cancelled.
[[nodiscard]] CutMesh cut_triangles(const CrossedMesh& mesh, const Context& context);

}  // namespace blum::detail
