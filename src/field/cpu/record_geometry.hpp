// Blum: closest points and sides of single records, one at a time. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "blum/core/vec3.hpp"
#include "field/cpu/site_records.hpp"

namespace blum::cpu {

inline Vec3f vec_at(const Record& record, int column) {
  const auto at = static_cast<std::size_t>(column);
  return {record.column[at], record.column[at + 1], record.column[at + 2]};
}
inline float value_at(const Record& record, int column) {
  return record.column[static_cast<std::size_t>(column)];
}
inline Vec3d to_double(const Vec3f& v) {
  return {v.x, v.y, v.z};
}
inline Vec3f to_float(const Vec3d& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// A point of the surface and which record it lies on.
struct Witness {
  Vec3f point{};
  Kind kind = vertex_kind;
  const Record* record = nullptr;
  float squared_distance = std::numeric_limits<float>::infinity();  ///< to the query that found it
};

inline Vec3d closest_on_segment(const Vec3d& query, const Vec3d& a, const Vec3d& b) {
  const Vec3d direction = b - a;
  const double squared = squared_length(direction);
  if (!(squared > 0)) return a;
  return a + direction * std::clamp(dot(query - a, direction) / squared, 0.0, 1.0);
}

/// Closest point of a closed, possibly very flat triangle, in double.
inline Vec3d closest_on_triangle(const Vec3d& query, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d normal = cross(b - a, c - a);
  const double squared_normal = squared_length(normal);
  if (squared_normal > 0 && dot(cross(b - a, query - a), normal) >= 0 && dot(cross(c - b, query - b), normal) >= 0 &&
      dot(cross(a - c, query - c), normal) >= 0) {
    return query - normal * (dot(query - a, normal) / squared_normal);
  }
  Vec3d best = closest_on_segment(query, a, b);
  for (const Vec3d& other : {closest_on_segment(query, b, c), closest_on_segment(query, c, a)}) {
    if (squared_length(query - other) < squared_length(query - best)) best = other;
  }
  return best;
}

inline Vec3d closest_on_sliver(const Record& record, const Vec3d& query) {
  return closest_on_triangle(query, to_double(vec_at(record, 0)), to_double(vec_at(record, 3)),
                             to_double(vec_at(record, 6)));
}

/// Closest point of a record's closed site, or none for a face whose prism the query lies outside of (its edges and
/// corners, or theirs, are closer).
inline bool closest_on_record(Kind kind, const Record& record, const Vec3f& query, Vec3f& point) {
  switch (kind) {
    case vertex_kind:
      point = vec_at(record, VertexColumns::position);
      return true;
    case edge_kind: {
      const Vec3f midpoint = vec_at(record, EdgeColumns::midpoint);
      const Vec3f tangent = vec_at(record, EdgeColumns::tangent);
      const float half = value_at(record, EdgeColumns::half_length);
      point = midpoint + tangent * std::clamp(dot(query - midpoint, tangent), -half, half);
      return true;
    }
    case face_kind: {
      const Vec3f from_anchor = query - vec_at(record, FaceColumns::anchor);
      const float minus_u = dot(from_anchor, vec_at(record, FaceColumns::minus_u));
      const float minus_v = dot(from_anchor, vec_at(record, FaceColumns::minus_v));
      if (minus_u > 0 || minus_v > 0 || minus_u + minus_v < -1) return false;
      const Vec3f normal = vec_at(record, FaceColumns::normal);
      point = query - normal * dot(from_anchor, normal);
      return true;
    }
    case sliver_kind:
      point = to_float(closest_on_sliver(record, to_double(query)));
      return true;
  }
  return false;
}

/// A side is called only if the pseudonormal is at least this far (as a cosine) from being perpendicular.
inline constexpr float clear_side = 0.01F;
/// Nor is it called this close to the surface, in the normalised frame.
inline constexpr float smallest_side = 1e-6F;

/// Component of a vector along an edge's unit pseudonormal, the sum of its faces' normals. With the second face's
/// direction given in the frame of b and n, that sum is side * (second_n b + (1 - second_b) n).
inline float edge_side(const Record& record, const Vec3f& from_midpoint) {
  const Vec3f binormal = vec_at(record, EdgeColumns::binormal);
  const Vec3f normal = cross(vec_at(record, EdgeColumns::tangent), binormal);
  const float rest = 1 - value_at(record, EdgeColumns::second_b);
  const float scale = value_at(record, EdgeColumns::side) / std::sqrt(std::max(2 * rest, 1e-12F));
  return scale *
         (value_at(record, EdgeColumns::second_n) * dot(from_midpoint, binormal) + rest * dot(from_midpoint, normal));
}

/// Which side of a closed mesh a query lies on, from its closest site: +1 outside, -1 inside, 0 too close to call.
inline int side_of(const Witness& closest, const Vec3f& query, const std::vector<Vec3f>& vertex_sides) {
  const Record& record = *closest.record;
  float side = 0;
  if (closest.kind == vertex_kind) {
    side = dot(query - vec_at(record, VertexColumns::position), vertex_sides[record.id]);
  } else if (closest.kind == edge_kind) {
    const Vec3f from_midpoint = query - vec_at(record, EdgeColumns::midpoint);
    const Vec3f tangent = vec_at(record, EdgeColumns::tangent);
    if (std::abs(dot(from_midpoint, tangent)) > value_at(record, EdgeColumns::half_length)) return 0;
    side = edge_side(record, from_midpoint);
  } else if (closest.kind == face_kind) {
    side = dot(query - vec_at(record, FaceColumns::anchor), vec_at(record, FaceColumns::normal));
  }
  if (std::abs(side) < std::max(clear_side * length(query - closest.point), smallest_side)) return 0;
  return side > 0 ? 1 : side < 0 ? -1 : 0;
}

}  // namespace blum::cpu
