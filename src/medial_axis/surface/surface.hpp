// Blum: the surface of a solid, as a medial axis sees it. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/bvh.hpp"

namespace blum::detail {

/// A point of a surface and an element (a triangle; a voxel beyond the surface) that it lies on.
struct Footprint {
  Vec3d point;
  std::uint32_t element = 0;
  unsigned corners = 7;  ///< triangles: a bit for each corner of the smallest feature around the point
};

/// The closest point of a surface, exactly.
struct NearestPoint {
  Vec3d point;
  double distance = 0;
  SiteId site;
  std::uint32_t element = 0;  ///< one that the site lies on
};

/// A point of a surface, and where the solid is.
struct SurfacePoint {
  Vec3d at;
  Vec3d inwards;  ///< unit length: between the directions of the elements there
};

/// What of a surface may be in a box.
struct SurfacePart {
  Box3 box;
  BvhPart found;
};

/// What the construction of a medial axis asks of the boundary of a solid. Functions may be called from many threads.
class Surface {
 public:
  Surface() = default;
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;
  virtual ~Surface() = default;

  /// The closest point of what a field gives a voxel as its closest site.
  /// @param centre  of the voxel.
  [[nodiscard]] virtual Footprint footprint(SiteId site, const Vec3d& centre, bool is_inside) const = 0;

  /// Where the footprints on a site are, to within half a voxel along each axis; nullopt where sites are large.
  [[nodiscard]] virtual std::optional<Vec3d> rough_footprint(SiteId /*site*/) const { return std::nullopt; }

  /// Walks from a footprint to the nearest local minimum of the distance: what the footprint on this part of the
  /// surface becomes when its point moves a little, while another part may be closer.
  /// @param reach  how far the footprint may move, mesh units; beyond that the last one within is returned.
  [[nodiscard]] virtual Footprint follow(const Footprint& start, const Vec3d& query, double reach) const = 0;

  /// The closest point of the whole surface. @param near  a footprint that is about as close.
  [[nodiscard]] virtual NearestPoint nearest(const Vec3d& query, const Footprint& near) const = 0;

  /// Whether a point is in the solid. @param nearest  its closest point of the surface.
  [[nodiscard]] virtual bool is_inside(const Vec3d& query, const NearestPoint& nearest) const = 0;

  /// What of the surface may be in a box: with it, first_crossing() and crosses() are answered quicker for points in
  /// the box. nullopt where that is of no use.
  [[nodiscard]] virtual std::optional<SurfacePart> part_in(const Box3& /*box*/) const { return std::nullopt; }

  /// Where a segment first meets the surface, as a part of its length; nullopt where it does not, and where that is not
  /// known. @param part  of a box that holds the segment, or null.
  [[nodiscard]] virtual std::optional<double> first_crossing(const Vec3d& /*from*/, const Vec3d& /*to*/,
                                                             const SurfacePart* /*part*/) const {
    return std::nullopt;
  }

  /// Whether a triangle, which need not be one of the surface, and the surface cross; false where that is not known.
  /// @param part  of a box that holds the triangle, or null.
  [[nodiscard]] virtual bool crosses(const Vec3d& /*a*/, const Vec3d& /*b*/, const Vec3d& /*c*/,
                                     const SurfacePart* /*part*/) const {
    return false;
  }

  /// Points on a short way over the surface from one element to another, each on an edge between two elements; nullopt
  /// where there is none within a box, where it is long, and where elements have no edges.
  [[nodiscard]] virtual std::optional<std::vector<SurfacePoint>> way_over(std::uint32_t /*from*/, std::uint32_t /*to*/,
                                                                          const Box3& /*within*/) const {
    return std::nullopt;
  }

  /// Points on the elements that meet a box: in the middle of each edge's part in it, and where edges go through its
  /// sides, or its edges through elements. Moved inwards a little, those of one element in the box see one another.
  [[nodiscard]] virtual std::vector<SurfacePoint> points_in(const Box3& /*box*/) const { return {}; }

  /// A point deep in each void that is known, by rising x; see points_of_voids().
  [[nodiscard]] virtual std::span<const Vec3d> voids() const { return {}; }

  /// The direction that an element faces away from the solid, of unit length; zero where that is not known.
  [[nodiscard]] virtual Vec3d outwards(std::uint32_t /*element*/) const { return {}; }

  /// The site that a footprint lies on.
  [[nodiscard]] virtual SiteId site_of(const Footprint& foot) const = 0;
};

}  // namespace blum::detail
