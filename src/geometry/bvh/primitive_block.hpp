// Blum: eight triangles, segments or points, and the closest site among them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/ray.hpp"
#include "geometry/lanes.hpp"

namespace blum {

/// Eight primitives as triangles with corners in rising order of vertex index, so that everyone who evaluates a shared
/// edge gets the same bits. A segment is a triangle whose last two corners agree, a point one with three equal corners.
struct alignas(64) PrimitiveBlock {
  double corner[3][3][lanes];  ///< [corner][axis][lane]
  /// 0, or for slivers, where the plane is ill-conditioned, the altitude: the border is at most this much too far.
  double sliver_altitude[lanes];
  std::uint32_t vertex[3][lanes];  ///< vertex of each corner
  std::uint32_t edge[3][lanes];    ///< site of the edges 01, 12, 02; none where there is no such edge
  std::uint32_t face[lanes];       ///< site of the face; none for segments and points

  void set(std::size_t lane, const std::array<Vec3d, 3>& corners, const std::array<std::uint32_t, 3>& vertices,
           const std::array<SiteId, 3>& edges, SiteId face_site);
  /// The same primitive with its corners elsewhere.
  void place(std::size_t lane, const std::array<Vec3d, 3>& corners);
  [[nodiscard]] Vec3d position(std::size_t k, std::size_t lane) const {
    return {corner[k][0][lane], corner[k][1][lane], corner[k][2][lane]};
  }
};

/// The best site so far.
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

/// Distances from a point to eight closed primitives, good to about 1e-12 of the lengths involved; for slivers a lower
/// bound.
void approximate_distances(const PrimitiveBlock& block, const Vec3d& query, double (&out)[lanes]);

/// A bit for each triangle of a block that a ray may cross between its origin and t = end: not those that its line for
/// certain goes by, nor those in whose plane it neither begins nor arrives. @param end  may be infinite.
[[nodiscard]] unsigned may_cross(const PrimitiveBlock& block, const Ray& ray, double end);

/// A bit for each triangle of a block that may have a point in common with a box: not those whose boxes do not touch
/// it, nor those that it lies for certain on one side of the plane of.
[[nodiscard]] unsigned may_reach(const PrimitiveBlock& block, const Box3& box);

/// A triangle that others are compared with.
struct ProbeTriangle {
  std::array<Vec3d, 3> corners;
  Box3 box;
  Vec3d normal;     ///< (b - a) x (c - a)
  Vec3d magnitude;  ///< of the products that are summed up to the normal

  explicit ProbeTriangle(const std::array<Vec3d, 3>& triangle);
};

/// A bit for each triangle of a block that may have a point in common with another one: not those whose boxes do not
/// touch, nor those of which one lies for certain on one side of the other's plane.
[[nodiscard]] unsigned may_meet(const PrimitiveBlock& block, const ProbeTriangle& other);

/// Offers the closest site of one primitive, with its distance good to rounding of the lengths involved, whatever the
/// shape of the triangle.
void offer_closest(const PrimitiveBlock& block, std::size_t lane, const Vec3d& query, SiteCandidate& best);

}  // namespace blum
