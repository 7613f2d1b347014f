// Blum: eight triangles, segments or points, and the closest site among them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/ray.hpp"
#include "geometry/lanes.hpp"

namespace blum {

/// Eight primitives, stored as triangles with corners in ascending order of vertex index. So every evaluation of a
/// shared edge gives bitwise the same result. A segment is a triangle whose last two corners are equal; a point has
/// three equal corners.
struct alignas(64) PrimitiveBlock {
  double corner[3][3][lanes];  ///< [corner][axis][lane]
  /// Altitude if the triangle is a sliver, whose plane is inaccurate; else 0. The border of a sliver is at most this
  /// altitude further away than the sliver.
  double sliver_altitude[lanes];
  std::uint32_t vertex[3][lanes];  ///< mesh vertex at each corner
  std::uint32_t edge[3][lanes];    ///< site ids of the edges 01, 12, 02; none if the edge does not exist
  std::uint32_t face[lanes];       ///< site id of the face; none for segments and points

  void set(std::size_t lane, const std::array<Vec3d, 3>& corners, const std::array<std::uint32_t, 3>& vertices,
           const std::array<SiteId, 3>& edges, SiteId face_site);
  /// Moves the corners of a primitive.
  void place(std::size_t lane, const std::array<Vec3d, 3>& corners);
  [[nodiscard]] Vec3d position(std::size_t k, std::size_t lane) const {
    return {corner[k][0][lane], corner[k][1][lane], corner[k][2][lane]};
  }
};

/// Best site found so far.
struct SiteCandidate {
  double distance = HUGE_VAL;
  Vec3d point;
  SiteId site;

  void offer(double other_distance, const Vec3d& other_point, std::uint32_t other_site) {
    if (other_distance < distance || (other_distance == distance && other_site < site.value)) {
      *this = {other_distance, other_point, SiteId(other_site)};
    }
  }
};

/// Computes distances from a point to eight primitives, borders included. The distances are accurate to about 1e-12 of
/// the lengths involved. For slivers, they are lower bounds.
void approximate_distances(const PrimitiveBlock& block, const Vec3d& query, double (&out)[lanes]);

/// Returns a bit for each triangle of a block that a ray may cross between its origin and t = end. The bit is 0 for
/// triangles that the ray's line certainly misses, and for triangles whose plane the ray certainly does not reach.
/// @param end  may be infinite.
[[nodiscard]] unsigned may_cross(const PrimitiveBlock& block, const Ray& ray, double end);

/// Returns a bit for each triangle of a block that may share a point with a box. The bit is 0 if the triangle's
/// bounding box does not touch the box. It is also 0 if the box is certainly on one side of the triangle's plane.
[[nodiscard]] unsigned may_reach(const PrimitiveBlock& block, const Box3& box);

/// Triangle that is compared with the triangles of blocks.
struct ProbeTriangle {
  std::array<Vec3d, 3> corners;
  Box3 box;
  Vec3d normal;     ///< (b - a) x (c - a), for corners a, b, c
  Vec3d magnitude;  ///< per component of the normal: sum of the magnitudes of its products

  explicit ProbeTriangle(const std::array<Vec3d, 3>& triangle);
};

/// Returns a bit for each triangle of a block that may share a point with another triangle. The bit is 0 if the
/// bounding boxes do not touch, or if one triangle certainly lies on one side of the other triangle's plane.
[[nodiscard]] unsigned may_meet(const PrimitiveBlock& block, const ProbeTriangle& other);

/// Replaces `best` by the closest site of one primitive if that site is closer. The distance is accurate to rounding of
/// the lengths involved, for triangles of every shape.
void offer_closest(const PrimitiveBlock& block, std::size_t lane, const Vec3d& query, SiteCandidate& best);

}  // namespace blum
