// Blum: closest points of single records. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "field/kernels/record.hpp"

namespace blum::kernels {

BLUM_HD inline Vec3d closest_on_segment(const Vec3d& query, const Vec3d& a, const Vec3d& b) {
  const Vec3d direction = b - a;
  const double squared = squared_length(direction);
  if (!(squared > 0)) return a;
  return a + direction * clamped(dot(query - a, direction) / squared, 0.0, 1.0);
}

/// Returns the closest point of a triangle, border included, in double. The triangle may be very flat.
BLUM_HD inline Vec3d closest_on_triangle(const Vec3d& query, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d normal = cross(b - a, c - a);
  const double squared_normal = squared_length(normal);
  if (squared_normal > 0 && dot(cross(b - a, query - a), normal) >= 0 && dot(cross(c - b, query - b), normal) >= 0 &&
      dot(cross(a - c, query - c), normal) >= 0) {
    return query - normal * (dot(query - a, normal) / squared_normal);
  }
  const Vec3d candidates[3] = {closest_on_segment(query, a, b), closest_on_segment(query, b, c),
                               closest_on_segment(query, c, a)};
  Vec3d best = candidates[0];
  for (int k = 1; k < 3; ++k) {
    if (squared_length(query - candidates[k]) < squared_length(query - best)) best = candidates[k];
  }
  return best;
}

/// Slivers are rare. Not inlined, so that they cost the common paths no registers. Corners are passed by value, so that
/// records need not be in memory.
BLUM_HD BLUM_NOINLINE inline Vec3d closest_on_flat_triangle(Vec3d query, Vec3f a, Vec3f b, Vec3f c) {
  return closest_on_triangle(query, to_double(a), to_double(b), to_double(c));
}

BLUM_HD inline Vec3d closest_on_sliver(const Record& record, const Vec3d& query) {
  return closest_on_flat_triangle(query, vec_at(record, SliverColumns::corners),
                                  vec_at(record, SliverColumns::corners + 3),
                                  vec_at(record, SliverColumns::corners + 6));
}

/// Returns the closest point of an edge, ends included.
BLUM_HD inline Vec3f closest_on_edge(const Record& record, const Vec3f& query) {
  const Vec3f midpoint = vec_at(record, EdgeColumns::midpoint);
  const Vec3f tangent = vec_at(record, EdgeColumns::tangent);
  const float half = value_at(record, EdgeColumns::half_length);
  return midpoint + tangent * clamped(dot(query - midpoint, tangent), -half, half);
}

/// Finds the closest point of a face. Returns false if the query does not project into the face: then an edge or corner
/// of it is closer.
BLUM_HD inline bool closest_on_face(const Record& record, const Vec3f& query, Vec3f& point) {
  const Vec3f from_anchor = query - vec_at(record, FaceColumns::anchor);
  const float minus_u = dot(from_anchor, vec_at(record, FaceColumns::minus_u));
  const float minus_v = dot(from_anchor, vec_at(record, FaceColumns::minus_v));
  if (minus_u > 0 || minus_v > 0 || minus_u + minus_v < -1) return false;
  const Vec3f normal = vec_at(record, FaceColumns::normal);
  point = query - normal * dot(from_anchor, normal);
  return true;
}

}  // namespace blum::kernels
