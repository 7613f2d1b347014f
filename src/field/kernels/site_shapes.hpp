// Blum: records of single faces and edges. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/geometry/triangle_mesh.hpp"
#include "field/kernels/record.hpp"

namespace blum::kernels {

/// Sites shorter or flatter than this cannot be distinguished from their border in float32. The frame's diagonal is
/// about one.
inline constexpr double negligible_length = 1e-12;
inline constexpr double negligible_altitude = 1e-7;
/// If a face's condition is larger, rounding of its barycentric coordinates would reach beyond its corners
/// (docs/theory/fields.md).
inline constexpr double largest_condition = 64;
/// If a triangle's relative altitude is larger, rounding in double turns its normal by at most about 1e-9, so the
/// normal is trusted.
inline constexpr double smallest_relative_altitude = 1e-7;

/// Returns the unit vector, using one division instead of three.
BLUM_HD inline Vec3d unit(const Vec3d& v, double length_of_v) {
  return v * (1 / length_of_v);
}

/// Face as its record needs it: corners with the anchor first, and the condition of the barycentric coordinates.
struct FaceShape {
  Vec3d anchor, to_u, to_v, normal;
  double doubled_area = 0;
  bool is_negligible = true;
  bool is_sliver = false;
  bool has_normal = false;

  [[nodiscard]] BLUM_HD bool has_record() const { return !is_negligible && !is_sliver; }
};

BLUM_HD inline FaceShape shape_of_face(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d corner[3] = {a, b, c};
  const double squared_side[3] = {squared_length(c - b), squared_length(a - c), squared_length(b - a)};
  int opposite = squared_side[0] < squared_side[1] ? 1 : 0;
  if (squared_side[opposite] < squared_side[2]) opposite = 2;
  FaceShape shape;
  shape.anchor = corner[opposite];
  shape.to_u = corner[(opposite + 1) % 3] - shape.anchor;
  shape.to_v = corner[(opposite + 2) % 3] - shape.anchor;
  const Vec3d area_normal = cross(shape.to_u, shape.to_v);
  const double squared_longest = squared_side[opposite];
  const double squared_area = squared_length(area_normal);
  if (!(squared_area > 0)) return shape;
  shape.doubled_area = root(squared_area);
  shape.normal = unit(area_normal, shape.doubled_area);
  shape.has_normal = shape.doubled_area > smallest_relative_altitude * squared_longest;
  shape.is_negligible = !(squared_area > negligible_altitude * negligible_altitude * squared_longest);
  // The condition is |grad u| |to_u| + |grad v| |to_v|, with |grad u| = |to_v| / doubled area and |grad v| = |to_u| /
  // doubled area.
  const double squared_sides = squared_side[(opposite + 1) % 3] * squared_side[(opposite + 2) % 3];
  shape.is_sliver = 4 * squared_sides > largest_condition * largest_condition * squared_area;
  return shape;
}

/// Writes all columns except the reaches. Does not write the id.
BLUM_HD inline void write_face(const FaceShape& shape, Record& record) {
  store(record, FaceColumns::anchor, shape.anchor);
  store(record, FaceColumns::normal, shape.normal);
  store(record, FaceColumns::minus_u, unit(cross(shape.normal, shape.to_v), shape.doubled_area));
  store(record, FaceColumns::minus_v, unit(cross(shape.to_u, shape.normal), shape.doubled_area));
}

/// Edge, and the unit directions that lead from the edge into its faces, at most two.
struct EdgeShape {
  Vec3d start, end, tangent;
  double length = 0;
  Vec3d first, second;  ///< unit vectors; `second` is set only if `first` is
  bool has_first = false;
  bool has_second = false;
};

BLUM_HD inline Vec3d any_perpendicular(const Vec3d& t) {
  const Vec3d axis = magnitude(t.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d b = cross(t, axis);
  return b / norm(b);
}

/// Returns true if a triangle traverses the edge from its first end to its second.
BLUM_HD constexpr bool runs_along(const Triangle& t, const Segment& edge) {
  return (t[0] == edge[0] && t[1] == edge[1]) || (t[1] == edge[0] && t[2] == edge[1]) ||
         (t[2] == edge[0] && t[0] == edge[1]);
}

/// Returns the unit direction that leads from an edge with this tangent into a triangle to its left (if `is_forward`)
/// or right.
BLUM_HD inline Vec3d in_face_direction(const Vec3d& normal, const Vec3d& tangent, bool is_forward) {
  return is_forward ? cross(normal, tangent) : cross(tangent, normal);
}

/// Writes all columns except the reach. Does not write the id.
/// @param normal  normal of the edge's first triangle.
BLUM_HD inline void write_edge(const EdgeShape& edge, const Vec3d& normal, Record& record) {
  const Vec3d b = edge.has_first ? edge.first : any_perpendicular(edge.tangent);
  const Vec3d n = cross(edge.tangent, b);
  store(record, EdgeColumns::midpoint, (edge.start + edge.end) * 0.5);
  store(record, EdgeColumns::tangent, edge.tangent);
  store(record, EdgeColumns::half_length, 0.5 * edge.length);
  store(record, EdgeColumns::binormal, b);
  store(record, EdgeColumns::first_limit, edge.has_first ? plane_slack : 1e30);
  if (edge.has_second) {
    store(record, EdgeColumns::second_b, dot(edge.second, b));
    store(record, EdgeColumns::second_n, dot(edge.second, n));
    // If two faces nearly fold onto each other, float32 cannot decide the pseudonormal. Such edges are left to exact
    // queries.
    const bool is_folded = 1 - dot(edge.second, b) < 1e-5;
    store(record, EdgeColumns::side, is_folded ? 0.0 : dot(normal, n) > 0 ? 1.0 : -1.0);
  }
}

/// Finds the two unit directions that bound an edge's domain. Each is perpendicular to one of the faces and leads away
/// from the other face. Returns false if the domain may be a half-plane or larger.
BLUM_HD inline bool edge_borders(const EdgeShape& edge, Vec3d borders[2]) {
  if (!edge.has_first || !edge.has_second) return false;
  const Vec3d first_normal = cross(edge.tangent, edge.first);
  const Vec3d second_normal = cross(edge.tangent, edge.second);
  // Each face has two perpendicular directions. The one that bounds the domain does not lead into the other face. If
  // the faces are nearly in one plane, rounding may make both acceptable. Then the domain may be a half-plane or
  // larger.
  const double side = dot(first_normal, edge.second);
  if (!(magnitude(side) > 1e-5)) return false;
  borders[0] = side < 0 ? first_normal : -first_normal;
  borders[1] = dot(second_normal, edge.first) < 0 ? second_normal : -second_normal;
  return true;
}

}  // namespace blum::kernels
