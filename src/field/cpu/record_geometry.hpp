// Blum: closest points and sides of single records, one at a time. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "blum/core/vec3.hpp"
#include "field/cpu/site_records.hpp"
#include "field/kernels/record_geometry.hpp"

namespace blum::cpu {

using kernels::closest_on_sliver;
using kernels::store;
using kernels::to_double;
using kernels::to_float;
using kernels::value_at;
using kernels::vec_at;

/// Point of the surface, and the record that it lies on.
struct Witness {
  Vec3f point{};
  Kind kind = vertex_kind;
  const Record* record = nullptr;
  float squared_distance = std::numeric_limits<float>::infinity();  ///< to the query that found it
};

/// Finds the closest point of a record, by the kernels' function for its kind. Returns false for a face if the query
/// lies outside of its prism.
inline bool closest_on_record(Kind kind, const Record& record, const Vec3f& query, Vec3f& point) {
  switch (kind) {
    case vertex_kind:
      point = vec_at(record, VertexColumns::position);
      return true;
    case edge_kind:
      point = kernels::closest_on_edge(record, query);
      return true;
    case face_kind:
      return kernels::closest_on_face(record, query, point);
    case sliver_kind:
      point = to_float(closest_on_sliver(record, to_double(query)));
      return true;
  }
  return false;
}

/// A side is decided only if the pseudonormal is at least this far (as a cosine) from being perpendicular.
inline constexpr float clear_side = 0.01F;
/// A side is not decided this close to the surface, in the normalised frame.
inline constexpr float smallest_side = 1e-6F;

/// Returns the component of a vector along an edge's unit pseudonormal, the sum of its faces' normals. With the second
/// face's direction given in the frame of b and n, that sum is side * (second_n b + (1 - second_b) n).
inline float edge_side(const Record& record, const Vec3f& from_midpoint) {
  const Vec3f binormal = vec_at(record, EdgeColumns::binormal);
  const Vec3f normal = cross(vec_at(record, EdgeColumns::tangent), binormal);
  const float rest = 1 - value_at(record, EdgeColumns::second_b);
  const float scale = value_at(record, EdgeColumns::side) / std::sqrt(std::max(2 * rest, 1e-12F));
  return scale *
         (value_at(record, EdgeColumns::second_n) * dot(from_midpoint, binormal) + rest * dot(from_midpoint, normal));
}

/// Returns the side of a closed mesh that a query lies on, from its closest site: +1 outside, -1 inside, 0 too close to
/// call.
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
