// Blum: distances of single nodes by linear factorization. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "field/kernels/box_forest.hpp"
#include "field/kernels/record_geometry.hpp"

namespace blum::kernels {

/// The closest site of a node so far.
struct Winner {
  float squared = std::numeric_limits<float>::max();
  std::uint32_t id = dead_record;

  /// Equal distances go to the smaller id, so that the order of the offers does not matter.
  BLUM_HD void offer(float candidate, std::uint32_t candidate_id) {
    if (candidate < squared || (candidate == squared && candidate_id < id)) {
      squared = candidate;
      id = candidate_id;
    }
  }
};

BLUM_HD inline void offer_vertex(const Record& record, const Vec3f& node, Winner& winner) {
  const Vec3f to = node - vec_at(record, VertexColumns::position);
  bool is_inside = true;
  for (int k = 0; k < 4; ++k) {
    is_inside = is_inside && dot(to, vec_at(record, VertexColumns::direction + 3 * k)) < plane_slack;
  }
  if (is_inside) winner.offer(squared_length(to), record.id);
}

BLUM_HD inline void offer_edge(const Record& record, const Vec3f& node, Winner& winner) {
  const Vec3f to = node - vec_at(record, EdgeColumns::midpoint);
  const Vec3f t = vec_at(record, EdgeColumns::tangent);
  const Vec3f b = vec_at(record, EdgeColumns::binormal);
  const float across_b = dot(to, b);
  const float across_n = dot(to, cross(t, b));
  // Beyond its ends the edge is as far as its end: the excess keeps the distance exact within the slack.
  const float excess = magnitude(dot(to, t)) - value_at(record, EdgeColumns::half_length);
  const float second =
      value_at(record, EdgeColumns::second_b) * across_b + value_at(record, EdgeColumns::second_n) * across_n;
  if (!(excess < plane_slack && across_b < value_at(record, EdgeColumns::first_limit) && second < plane_slack)) return;
  const float beyond = larger(excess, 0.0F);
  winner.offer(across_b * across_b + (across_n * across_n + beyond * beyond), record.id);
}

BLUM_HD inline void offer_sliver(const Record& record, const Vec3f& node, Winner& winner) {
  const Vec3d query = to_double(node);
  winner.offer(static_cast<float>(squared_length(query - closest_on_sliver(record, query))), record.id);
}

BLUM_HD inline void offer_face(const Record& record, const Vec3f& node, Winner& winner) {
  const Vec3f to = node - vec_at(record, FaceColumns::anchor);
  const float minus_u = dot(to, vec_at(record, FaceColumns::minus_u));
  const float minus_v = dot(to, vec_at(record, FaceColumns::minus_v));
  if (!(minus_u < 0 && minus_v < 0 && minus_u + minus_v > -1)) return;
  const float height = dot(to, vec_at(record, FaceColumns::normal));
  winner.offer(height * height, record.id);
}

/// Lets a site win a node that lies in its domain.
BLUM_HD inline void offer_site(std::uint32_t kind, const Record& record, const Vec3f& node, Winner& winner) {
  if (kind == vertex_kind) {
    offer_vertex(record, node, winner);
  } else if (kind == edge_kind) {
    offer_edge(record, node, winner);
  } else if (value_at(record, FaceColumns::is_sliver) != 0) {
    offer_sliver(record, node, winner);
  } else {
    offer_face(record, node, winner);
  }
}

}  // namespace blum::kernels
