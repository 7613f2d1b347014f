// Blum: triangles cut along what crosses them. SPDX-License-Identifier: Apache-2.0
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

/// Crossings that are not resolved: the reason.
class Unresolved : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A part of a triangle of the input, or one that is left whole.
struct Facet {
  std::array<PointId, 3> corners{};
  std::int32_t times = 1;    ///< how often the input has it, those that face the other way counted off; > 0
  std::uint32_t source = 0;  ///< triangle of the input that it lies in, and faces as
  std::uint32_t sheet = 0;   ///< the same for facets in one plane that were cut together
};

/// Triangles of a mesh without corners at one place, and pairs of them that cross or touch.
struct CrossedMesh {
  std::span<const Vec3d> vertices;  ///< of magnitude 2 at most
  std::span<const Triangle> triangles;
  std::span<const std::uint8_t> is_flat;  ///< triangles whose corners lie on one line: not 0; 2: in two places at most
  std::span<const TrianglePair> pairs;
};

struct CutMesh {
  ExactSpace space;
  std::vector<Facet> facets = {};
  std::vector<std::uint32_t> sheet_of = {};  ///< of each triangle of the input
  std::size_t cut = 0;                       ///< triangles of the input that others cross or touch, or beside these
};

/// Cuts the triangles that cross or touch others, so that what two of them have in common is made of edges and corners
/// of both; triangles that overlap in a plane become one set of facets. Others stay as they are, and flat ones go.
/// @throws Unresolved, Cancelled. The mesh must outlive the result.
[[nodiscard]] CutMesh cut_triangles(const CrossedMesh& mesh, const Context& context);

}  // namespace blum::detail
