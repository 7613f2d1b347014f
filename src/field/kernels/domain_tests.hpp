// Blum: tests if a site can be closest somewhere in a box of nodes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "field/kernels/box_forest.hpp"
#include "field/kernels/record_geometry.hpp"

namespace blum::kernels {

/// Length by which boxes are widened (normalised units). This length covers all rounding in the tests that cull sites
/// against boxes.
inline constexpr float box_slack = 3e-6F;

/// Box around nodes: centre and half-sizes in the normalised frame.
struct CenteredBox {
  Vec3f center;
  Vec3f half;  ///< reaches to the outermost nodes; not widened

  [[nodiscard]] BLUM_HD CenteredBox widened() const { return {center, half + Vec3f{box_slack, box_slack, box_slack}}; }
};

/// Surface points near a box, used to drop sites that are further away everywhere in it. The first point is closest to
/// the box's centre; points may repeat.
struct Dominators {
  static constexpr int count = 4;
  Vec3f point[count];
};

/// Drops sites that are further than a known surface point p0 everywhere in the box. Let pi be the projection of the
/// centre c on a site's flat (its line or plane). Then |x - p0|^2 < distance(x, flat)^2 for all x of the box if |c -
/// pi|^2 > |c - p0|^2 + 2 half . |p0 - pi| + (largest squared offset along the flat).
struct Domination {
  /// One surface point: c - p0, and |c - p0|^2 plus room for rounding.
  struct alignas(16) Point {
    Vec3f center_to_p0;
    float limit = 0;
  };
  Point point[Dominators::count];
  Vec3f half;
  float squared_half = 0;

  Domination() = default;
  /// @param box  must be widened by box_slack.
  BLUM_HD Domination(const CenteredBox& box, const Dominators& dominators)
      : half(box.half), squared_half(squared_length(box.half)) {
    for (int k = 0; k < Dominators::count; ++k) {
      const Vec3f to_p0 = box.center - dominators.point[k];
      const float squared = squared_length(to_p0);
      point[k] = {to_p0, squared + 4e-6F * squared + 2e-6F * root(squared) + 1e-12F};
    }
  }

  /// Returns false if some surface point is closer than the site everywhere in the box.
  /// @param to_flat  c - pi.
  [[nodiscard]] BLUM_HD bool keeps(const Vec3f& to_flat, float squared_distance, float along_flat) const {
    const float rest = squared_distance - along_flat;
    for (const Point& p : point) {
      if (!(rest <= 2 * support(p.center_to_p0 - to_flat, half) + p.limit)) return false;
    }
    return true;
  }
};

BLUM_HD inline bool vertex_matters(const Record& record, const CenteredBox& box, const Domination& domination) {
  const Vec3f to_site = box.center - vec_at(record, VertexColumns::position);
  for (int k = 0; k < 4; ++k) {
    const Vec3f e = vec_at(record, VertexColumns::direction + 3 * k);
    if (dot(to_site, e) > support(e, box.half) + plane_slack) return false;
  }
  return domination.keeps(to_site, squared_length(to_site), 0.0F);
}

BLUM_HD inline bool edge_matters(const Record& record, const CenteredBox& box, const Domination& domination) {
  const Vec3f to_site = box.center - vec_at(record, EdgeColumns::midpoint);
  const Vec3f t = vec_at(record, EdgeColumns::tangent);
  const float extent = support(t, box.half);
  if (magnitude(dot(to_site, t)) > value_at(record, EdgeColumns::half_length) + extent) return false;
  const Vec3f b = vec_at(record, EdgeColumns::binormal);
  const Vec3f n = cross(t, b);
  const float across_b = dot(to_site, b);
  const float across_n = dot(to_site, n);
  const float first_limit = value_at(record, EdgeColumns::first_limit);
  if (across_b > support(b, box.half) + first_limit) return false;
  const float second_b = value_at(record, EdgeColumns::second_b);
  const float second_n = value_at(record, EdgeColumns::second_n);
  const Vec3f second = b * second_b + n * second_n;
  const float across_second = second_b * across_b + second_n * across_n;
  constexpr float slack = 2 * plane_slack;
  if (across_second > support(second, box.half) + slack) return false;
  // The sum of both faces' directions cuts off the corner that the box test leaves. The middle of the wedge is opposite
  // to this sum. A point that is further than the reach along the sum lies outside of the domain.
  const Vec3f sum = b + second;
  const float across_sum = across_b + across_second;
  const float sum_support = support(sum, box.half) + slack;
  if (across_sum > sum_support + first_limit) return false;
  if (-across_sum > value_at(record, EdgeColumns::reach) * norm(sum) + sum_support) return false;
  const Vec3f to_flat = b * across_b + n * across_n;
  return domination.keeps(to_flat, across_b * across_b + across_n * across_n, extent * extent);
}

BLUM_HD inline bool sliver_matters(const Record& record, const CenteredBox& box, const Domination& domination) {
  const Vec3d center = to_double(box.center);
  const double beaten_beyond =
      norm(to_double(domination.point[0].center_to_p0)) * 1.0001 + 2 * norm(to_double(box.half)) + 4 * box_slack;
  return norm(center - closest_on_sliver(record, center)) <= beaten_beyond;
}

BLUM_HD inline bool face_matters(const Record& record, const CenteredBox& box, const Domination& domination) {
  if (value_at(record, FaceColumns::is_sliver) != 0) return sliver_matters(record, box, domination);
  const Vec3f to_site = box.center - vec_at(record, FaceColumns::anchor);
  // Each barycentric coordinate must lie in [0, 1] up to the box's extent: |coordinate - 1/2| - extent <= 1/2.
  const auto misses = [&](float minus_coordinate, const Vec3f& gradient) {
    return magnitude(minus_coordinate + 0.5F) - support(gradient, box.half) > 0.5F;
  };
  const Vec3f gradient_u = vec_at(record, FaceColumns::minus_u);
  const float minus_u = dot(to_site, gradient_u);
  if (misses(minus_u, gradient_u)) return false;
  const Vec3f gradient_v = vec_at(record, FaceColumns::minus_v);
  const float minus_v = dot(to_site, gradient_v);
  if (misses(minus_v, gradient_v) || misses(minus_u + minus_v, gradient_u + gradient_v)) return false;
  const Vec3f n = vec_at(record, FaceColumns::normal);
  const float height = dot(to_site, n);
  const float extent = support(n, box.half);
  if (height > extent + value_at(record, FaceColumns::reach_above) ||
      -height > extent + value_at(record, FaceColumns::reach_below)) {
    return false;
  }
  return domination.keeps(n * height, height * height, domination.squared_half);
}

/// Returns true if a site may be the closest site somewhere in a box. The record of the site must not be dead.
/// @param box  must be widened by box_slack.
BLUM_HD inline bool site_matters(std::uint32_t kind, const Record& record, const CenteredBox& box,
                                 const Domination& domination) {
  return kind == vertex_kind ? vertex_matters(record, box, domination)
         : kind == edge_kind ? edge_matters(record, box, domination)
                             : face_matters(record, box, domination);
}

/// Tests boxes around parts of the surface against a tile. Let p0 be a known surface point, x a point of the tile and p
/// one of the box. The box is dropped if p0 is closer to x than p for all x and p. That is, |x - p|^2 - |x - p0|^2 is
/// positive for all x and p. The minimum is separable by axis. Along an axis the difference is linear in x and convex
/// in p. So the minimum is at an end of the tile, with p as close to that end as the box allows.
struct TileTest {
  Vec3f low, high, low_p0, high_p0;
  float tolerance = 0;

  TileTest() = default;
  /// @param tile  must be widened by box_slack.
  BLUM_HD TileTest(const CenteredBox& tile, const Vec3f& p0)
      : low(tile.center - tile.half), high(tile.center + tile.half) {
    const Vec3f from_low = low - p0;
    const Vec3f from_high = high - p0;
    low_p0 = {from_low.x * from_low.x, from_low.y * from_low.y, from_low.z * from_low.z};
    high_p0 = {from_high.x * from_high.x, from_high.y * from_high.y, from_high.z * from_high.z};
    const float squared = squared_length(tile.center - p0);
    tolerance = 4e-6F * squared + 4e-6F * root(squared) + 1e-11F;
  }

  [[nodiscard]] BLUM_HD bool keeps(const ReachBox& box) const {
    if (box.is_empty()) return false;
    const float sum = axis(low.x, high.x, low_p0.x, high_p0.x, box.lower.x, box.upper.x) +
                      axis(low.y, high.y, low_p0.y, high_p0.y, box.lower.y, box.upper.y) +
                      axis(low.z, high.z, low_p0.z, high_p0.z, box.lower.z, box.upper.z);
    if (sum > tolerance) return false;
    const Vec3f apart{gap(low.x, high.x, box.lower.x, box.upper.x), gap(low.y, high.y, box.lower.y, box.upper.y),
                      gap(low.z, high.z, box.lower.z, box.upper.z)};
    return squared_length(apart) <= box.reach * box.reach;
  }

 private:
  BLUM_HD static float axis(float at_low, float at_high, float low_to_p0, float high_to_p0, float lower, float upper) {
    const float from_low = at_low - clamped(at_low, lower, upper);
    const float from_high = at_high - clamped(at_high, lower, upper);
    return smaller(from_low * from_low - low_to_p0, from_high * from_high - high_to_p0);
  }
  BLUM_HD static float gap(float low_end, float high_end, float lower_end, float upper_end) {
    return larger(larger(low_end - upper_end, lower_end - high_end), 0.0F);
  }
};

}  // namespace blum::kernels
