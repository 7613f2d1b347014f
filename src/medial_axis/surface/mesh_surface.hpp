// Blum: a triangle mesh as the surface of a solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/pseudonormals.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// Part of a segment in a box, as fractions of its length. At an end where a side of the box cuts the segment, the axis
/// is the one perpendicular to that side. At an uncut end it is unset.
struct SegmentPart {
  double low = 0, high = 1;
  std::optional<std::size_t> low_axis, high_axis;

  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
};

/// Returns the part of a segment in a box, or nullopt if the segment does not meet the box.
[[nodiscard]] std::optional<SegmentPart> part_within(const Vec3d& a, const Vec3d& b, const Box3& box);

/// Edge between two triangles of a surface.
struct ClippedEdge {
  std::array<Vec3d, 2> ends;
  std::array<Vec3d, 2> outwards;  ///< unit normals of the triangles; zero if a triangle has no area
};

/// Adds the middle of the part of an edge in a box, and the points where the edge crosses sides of the box. At a
/// crossing, `inwards` lies in the plane of the side.
void add_clip_points(const ClippedEdge& edge, const Box3& box, std::vector<SurfacePoint>& points);

/// Adds the points where edges of a box cross a triangle. At each point, `inwards` is the direction along the box edge
/// that leads into the solid.
void add_clip_points(const std::array<Vec3d, 3>& triangle, const Vec3d& outwards, const Box3& box,
                     std::vector<SurfacePoint>& points);

/// Triangle mesh as a surface; its elements are the triangles. The mesh and the site table must outlive it.
class MeshSurface final : public Surface {
 public:
  /// @param bounds_solid  true if the mesh is a closed surface that faces outwards. If false, every point is treated as
  /// outside.
  MeshSurface(const MeshView& mesh, const SiteTable& sites, bool bounds_solid, const Context& context);

  [[nodiscard]] Footprint footprint(SiteId site, const Vec3d& centre, bool is_inside) const override;
  [[nodiscard]] Footprint follow(const Footprint& start, const Vec3d& query, double reach) const override;
  [[nodiscard]] NearestPoint nearest(const Vec3d& query, const Footprint& near) const override;
  [[nodiscard]] bool is_inside(const Vec3d& query, const NearestPoint& nearest) const override {
    return bounds_solid_ && nearest.distance > 0 && normals_.is_inside(query, nearest.point, nearest.site);
  }
  [[nodiscard]] std::optional<SurfacePart> part_in(const Box3& box) const override;
  [[nodiscard]] std::optional<double> first_crossing(const Vec3d& from, const Vec3d& to,
                                                     const SurfacePart* part) const override;
  [[nodiscard]] bool crosses(const Vec3d& a, const Vec3d& b, const Vec3d& c, const SurfacePart* part) const override;
  [[nodiscard]] std::optional<std::vector<SurfacePoint>> way_over(std::uint32_t from, std::uint32_t to,
                                                                  const Box3& within) const override;
  [[nodiscard]] std::vector<SurfacePoint> points_in(const Box3& box) const override;
  [[nodiscard]] std::span<const Vec3d> voids() const override { return voids_; }
  [[nodiscard]] Vec3d outwards(std::uint32_t element) const override;
  [[nodiscard]] SiteId site_of(const Footprint& foot) const override;

 private:
  template <class Visit>
  void for_each_triangle_at(std::uint32_t a, std::uint32_t b, const Visit& visit) const;
  template <class Visit>
  void for_each_neighbour(std::uint32_t triangle, const Visit& visit) const;
  [[nodiscard]] Footprint closest_on(std::uint32_t triangle, const Vec3d& query) const;

  MeshView mesh_;
  const SiteTable& sites_;
  bool bounds_solid_;
  Bvh bvh_;
  double size_ = 0;  ///< diagonal of the bounds
  Pseudonormals normals_;
  std::vector<std::uint32_t> first_;      ///< for each vertex: index in triangles_ of its first triangle
  std::vector<std::uint32_t> triangles_;  ///< triangles of each vertex, vertex after vertex
  std::vector<Vec3d> voids_;
};

}  // namespace blum::detail
