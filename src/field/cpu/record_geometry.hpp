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

/// Point of the surface, and the record of the site that contains it.
struct Witness {
  Vec3f point{};
  Kind kind = vertex_kind;
  const Record* record = nullptr;
  float squared_distance = std::numeric_limits<float>::infinity();  ///< to the query that found it
};

/// Finds the point of a site that is closest to a query, by the kernels' function for the site's kind. Returns false
/// for a face if the query does not project into it.
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

/// Smallest cosine at which a sign is decided. It is the cosine of the angle between the pseudonormal (or its opposite)
/// and the direction to the query.
inline constexpr float clear_side = 0.01F;
/// The sign of a distance is not decided at distances below this, in the normalised frame.
inline constexpr float smallest_side = 1e-6F;

/// Returns the component of a vector along an edge's unit pseudonormal, the sum of its faces' normals. Let the second
/// face's direction be (second_b, second_n) in the frame of b and n. Then the sum is side * (second_n b + (1 -
/// second_b) n).
inline float edge_side(const Record& record, const Vec3f& from_midpoint) {
  const Vec3f binormal = vec_at(record, EdgeColumns::binormal);
  const Vec3f normal = cross(vec_at(record, EdgeColumns::tangent), binormal);
  const float rest = 1 - value_at(record, EdgeColumns::second_b);
  const float scale = value_at(record, EdgeColumns::side) / std::sqrt(std::max(2 * rest, 1e-12F));
  return scale *
         (value_at(record, EdgeColumns::second_n) * dot(from_midpoint, binormal) + rest * dot(from_midpoint, normal));
}

/// Returns the side of a closed mesh on which a query lies: +1 outside, -1 inside, 0 if uncertain. The closest site
/// decides.
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
