// Blum: the surface of a solid, for the construction of its medial axis. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/bvh.hpp"

namespace blum::detail {

/// Point of a surface and an element that contains it: a triangle, or a voxel outside the solid.
struct Footprint {
  Vec3d point;
  std::uint32_t element = 0;
  /// For a triangle: the bits of its corners that belong to the smallest feature (vertex, edge or face) around the
  /// point.
  unsigned corners = 7;
};

/// Closest point of a surface, exact up to rounding.
struct NearestPoint {
  Vec3d point;
  double distance = 0;
  SiteId site;
  std::uint32_t element = 0;  ///< an element that contains the site
};

/// Point of a surface, and a direction from it into the solid.
struct SurfacePoint {
  Vec3d at;
  Vec3d inwards;  ///< unit length: the mean of the inward directions of the elements at the point
};

/// The elements of a surface that may meet a box.
struct SurfacePart {
  Box3 box;
  BvhPart found;
};

/// The boundary of a solid, with the queries that the construction of a medial axis needs. Functions may be called from
/// many threads.
class Surface {
 public:
  Surface() = default;
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;
  virtual ~Surface() = default;

  /// Returns the footprint of a voxel's centre on the site that a field assigns to the voxel.
  /// @param centre  centre of the voxel.
  [[nodiscard]] virtual Footprint footprint(SiteId site, const Vec3d& centre, bool is_inside) const = 0;

  /// Returns a position that differs from each footprint on a site by at most half a voxel along each axis of the grid.
  /// Returns nullopt if sites are larger than a voxel.
  [[nodiscard]] virtual std::optional<Vec3d> rough_footprint(SiteId /*site*/) const { return std::nullopt; }

  /// Walks over the surface from a footprint to the nearest local minimum of the distance from the query. If the query
  /// has moved a little, the result is its footprint on the same part of the surface. Another part may be closer.
  /// @param reach  greatest distance of the result from the start, mesh units. The walk ends before it exceeds this
  /// distance.
  [[nodiscard]] virtual Footprint follow(const Footprint& start, const Vec3d& query, double reach) const = 0;

  /// Returns the closest point of the whole surface.
  /// @param near  a known point of the surface that is almost as close to the query. It makes the search faster.
  [[nodiscard]] virtual NearestPoint nearest(const Vec3d& query, const Footprint& near) const = 0;

  /// Returns true if a point is in the solid.
  /// @param nearest  the closest point of the surface to the query.
  [[nodiscard]] virtual bool is_inside(const Vec3d& query, const NearestPoint& nearest) const = 0;

  /// Returns the part of the surface that may be in a box, or nullopt if it would not save time. With this part,
  /// first_crossing() and crosses() are faster for points in the box.
  [[nodiscard]] virtual std::optional<SurfacePart> part_in(const Box3& /*box*/) const { return std::nullopt; }

  /// Returns the position at which a segment first meets the surface, as a fraction of the segment's length. Returns
  /// nullopt if they do not meet, or if the surface cannot compute this.
  /// @param part  result of part_in() for a box that contains the segment, or null.
  [[nodiscard]] virtual std::optional<double> first_crossing(const Vec3d& /*from*/, const Vec3d& /*to*/,
                                                             const SurfacePart* /*part*/) const {
    return std::nullopt;
  }

  /// Returns true if a triangle crosses the surface. The triangle need not belong to the surface. Returns false if the
  /// surface cannot compute this.
  /// @param part  result of part_in() for a box that contains the triangle, or null.
  [[nodiscard]] virtual bool crosses(const Vec3d& /*a*/, const Vec3d& /*b*/, const Vec3d& /*c*/,
                                     const SurfacePart* /*part*/) const {
    return false;
  }

  /// Returns points on a short path over the surface from one element to another. Each point is on an edge between two
  /// elements. Returns nullopt if no short path lies in the box, or if elements have no edges.
  [[nodiscard]] virtual std::optional<std::vector<SurfacePoint>> way_over(std::uint32_t /*from*/, std::uint32_t /*to*/,
                                                                          const Box3& /*within*/) const {
    return std::nullopt;
  }

  /// Returns points on the elements that meet a box. These are the middle of each edge's part in the box, and the
  /// points where edges cross sides of the box. The points where edges of the box cross elements are also included. If
  /// the points of one element are moved inwards a little, segments between them stay in the solid.
  [[nodiscard]] virtual std::vector<SurfacePoint> points_in(const Box3& /*box*/) const { return {}; }

  /// Returns points deep in voids, one for each void in which one was found, by ascending x; see points_of_voids().
  [[nodiscard]] virtual std::span<const Vec3d> voids() const { return {}; }

  /// Returns the unit direction in which an element faces away from the solid; zero if unknown.
  [[nodiscard]] virtual Vec3d outwards(std::uint32_t /*element*/) const { return {}; }

  /// Returns the site on which a footprint lies.
  [[nodiscard]] virtual SiteId site_of(const Footprint& foot) const = 0;
};

}  // namespace blum::detail
