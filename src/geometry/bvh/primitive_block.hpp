// Blum: eight triangles, segments or points, and the closest site among them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/ray.hpp"
#include "geometry/lanes.hpp"

namespace blum {

/// Eight primitives, stored as triangles with corners in rising order of vertex index. This order gives every
/// evaluation of a shared edge the same bits. A segment is a triangle whose last two corners are equal; a point has
/// three equal corners.
struct alignas(64) PrimitiveBlock {
  double corner[3][3][lanes];  ///< [corner][axis][lane]
  /// 0, or the altitude of a sliver, whose plane is ill-conditioned. The border is further away by at most this much.
  double sliver_altitude[lanes];
  std::uint32_t vertex[3][lanes];  ///< vertex of each corner
  std::uint32_t edge[3][lanes];    ///< sites of the edges 01, 12, 02; none if the edge does not exist
  std::uint32_t face[lanes];       ///< site of the face; none for segments and points

  void set(std::size_t lane, const std::array<Vec3d, 3>& corners, const std::array<std::uint32_t, 3>& vertices,
           const std::array<SiteId, 3>& edges, SiteId face_site);
  /// Moves the corners of a primitive.
  void place(std::size_t lane, const std::array<Vec3d, 3>& corners);
  [[nodiscard]] Vec3d position(std::size_t k, std::size_t lane) const {
    return {corner[k][0][lane], corner[k][1][lane], corner[k][2][lane]};
  }
};

/// The best site found so far.
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

/// Computes distances from a point to eight closed primitives, accurate to about 1e-12 of the lengths involved. For
/// slivers they are lower bounds.
void approximate_distances(const PrimitiveBlock& block, const Vec3d& query, double (&out)[lanes]);

/// Returns a bit for each triangle of a block that a ray may cross between its origin and t = end. Excludes triangles
/// that its line certainly misses, and those whose plane it certainly does not reach.
/// @param end  may be infinite.
[[nodiscard]] unsigned may_cross(const PrimitiveBlock& block, const Ray& ray, double end);

/// Returns a bit for each triangle of a block that may share a point with a box. Excludes triangles whose boxes do not
/// touch it, and those with the box certainly on one side of their plane.
[[nodiscard]] unsigned may_reach(const PrimitiveBlock& block, const Box3& box);

/// A triangle to compare others with.
struct ProbeTriangle {
  std::array<Vec3d, 3> corners;
  Box3 box;
  Vec3d normal;     ///< (b - a) x (c - a)
  Vec3d magnitude;  ///< sums of the magnitudes of the normal's products

  explicit ProbeTriangle(const std::array<Vec3d, 3>& triangle);
};

/// Returns a bit for each triangle of a block that may share a point with another one. Excludes pairs whose boxes do
/// not touch, and pairs in which one triangle certainly lies on one side of the other's plane.
[[nodiscard]] unsigned may_meet(const PrimitiveBlock& block, const ProbeTriangle& other);

/// Offers the closest site of one primitive. Its distance is accurate to rounding of the lengths involved, for every
/// shape of triangle.
void offer_closest(const PrimitiveBlock& block, std::size_t lane, const Vec3d& query, SiteCandidate& best);

}  // namespace blum
