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
  unsigned corners = 7;  ///< triangles: one bit for each corner of the smallest feature around the point
};

/// Exact closest point of a surface.
struct NearestPoint {
  Vec3d point;
  double distance = 0;
  SiteId site;
  std::uint32_t element = 0;  ///< one that contains the site
};

/// Point of a surface, with a direction into the solid.
struct SurfacePoint {
  Vec3d at;
  Vec3d inwards;  ///< unit length: between the directions of the elements at the point
};

/// Part of a surface that may be in a box.
struct SurfacePart {
  Box3 box;
  BvhPart found;
};

/// Queries of the boundary of a solid that the construction of a medial axis needs. Functions may be called from many
/// threads.
class Surface {
 public:
  Surface() = default;
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;
  virtual ~Surface() = default;

  /// Returns the closest point of the site that a field assigns to a voxel.
  /// @param centre  of the voxel.
  [[nodiscard]] virtual Footprint footprint(SiteId site, const Vec3d& centre, bool is_inside) const = 0;

  /// Returns the position of the footprints on a site, to within half a voxel along each axis of the grid. Returns
  /// nullopt if sites are large.
  [[nodiscard]] virtual std::optional<Vec3d> rough_footprint(SiteId /*site*/) const { return std::nullopt; }

  /// Walks from a footprint to the nearest local minimum of the distance. If the query has moved a little, this is its
  /// footprint on the same part of the surface. Another part may be closer.
  /// @param reach  greatest distance of the footprint from the start, mesh units. Beyond it, the last footprint within
  /// is returned.
  [[nodiscard]] virtual Footprint follow(const Footprint& start, const Vec3d& query, double reach) const = 0;

  /// Returns the closest point of the whole surface.
  /// @param near  a footprint that is about as close.
  [[nodiscard]] virtual NearestPoint nearest(const Vec3d& query, const Footprint& near) const = 0;

  /// Returns true if a point is in the solid.
  /// @param nearest  its closest point of the surface.
  [[nodiscard]] virtual bool is_inside(const Vec3d& query, const NearestPoint& nearest) const = 0;

  /// Returns the part of the surface that may be in a box, or nullopt if it would be of no use. With it,
  /// first_crossing() and crosses() are faster for points in the box.
  [[nodiscard]] virtual std::optional<SurfacePart> part_in(const Box3& /*box*/) const { return std::nullopt; }

  /// Returns the position at which a segment first meets the surface, as a fraction of its length. Returns nullopt if
  /// they do not meet or if that is unknown.
  /// @param part  of a box that contains the segment, or null.
  [[nodiscard]] virtual std::optional<double> first_crossing(const Vec3d& /*from*/, const Vec3d& /*to*/,
                                                             const SurfacePart* /*part*/) const {
    return std::nullopt;
  }

  /// Returns true if a triangle, which need not belong to the surface, and the surface cross. Returns false if that is
  /// unknown.
  /// @param part  of a box that contains the triangle, or null.
  [[nodiscard]] virtual bool crosses(const Vec3d& /*a*/, const Vec3d& /*b*/, const Vec3d& /*c*/,
                                     const SurfacePart* /*part*/) const {
    return false;
  }

  /// Returns points on a short way over the surface from one element to another, each on an edge between two elements.
  /// Returns nullopt if no way lies in the box, if it is long, or if elements have no edges.
  [[nodiscard]] virtual std::optional<std::vector<SurfacePoint>> way_over(std::uint32_t /*from*/, std::uint32_t /*to*/,
                                                                          const Box3& /*within*/) const {
    return std::nullopt;
  }

  /// Returns points on the elements that meet a box. They lie in the middle of each edge's part in the box, where edges
  /// cross its sides, and where its edges cross elements. Moved inwards a little, the points of one element in the box
  /// see one another.
  [[nodiscard]] virtual std::vector<SurfacePoint> points_in(const Box3& /*box*/) const { return {}; }

  /// Returns a point deep in each void for which one was found, by ascending x; see points_of_voids().
  [[nodiscard]] virtual std::span<const Vec3d> voids() const { return {}; }

  /// Returns the unit direction in which an element faces away from the solid; zero if unknown.
  [[nodiscard]] virtual Vec3d outwards(std::uint32_t /*element*/) const { return {}; }

  /// Returns the site on which a footprint lies.
  [[nodiscard]] virtual SiteId site_of(const Footprint& foot) const = 0;
};

}  // namespace blum::detail
