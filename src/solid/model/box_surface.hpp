// Blum: the part of a surface in a box. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/union_find.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/grid_predicates.hpp"
#include "solid/model/box_cells.hpp"
#include "solid/model/components.hpp"
#include "solid/model/surface_mesh.hpp"

namespace blum::detail {

/// Returns true if the bounding box of a triangle meets a box. Both boxes are closed.
[[nodiscard]] bool may_meet(const TriangleCorners& triangle, const Vec3d& low, const Vec3d& high);
/// Returns false if may_meet() returns false, or if a plane certainly separates the triangle from the box. Planes of
/// the triangle, and planes along one of its edges and an axis, are tested. These planes exclude slanted needles, which
/// are far smaller than their bounding boxes.
[[nodiscard]] bool may_reach(const TriangleCorners& t, const Vec3d& low, const Vec3d& high);

/// Returns true if a triangle crosses the segment along an axis between two points. The test is exact.
[[nodiscard]] bool crosses(const TriangleCorners& triangle, std::size_t axis, const Vec3d& low, const Vec3d& high);

/// Sorts triangles by the height at which they cross a line, lowest first. The line runs along an axis through a point.
/// The order is exact.
void sort_along(const SurfaceMesh& mesh, std::size_t axis, const Vec3d& on_line, std::vector<std::uint32_t>& triangles);

/// Returns true if an edge of a mesh passes through the rectangle between two corners, at a right angle to the axis
/// `across`. The test is exact.
[[nodiscard]] bool passes_through(const EdgeEnds& edge, std::size_t across, const Vec3d& low, const Vec3d& high);

/// Returns true if a point lies in a box, whose lower planes belong to it and whose upper planes do not. The test is
/// exact.
[[nodiscard]] bool is_in_box(const Vec3d& p, const BoxCell& box);

/// The connected pieces of a surface in an open box. An object may be reused.
class BoxPieces {
 public:
  /// An arc (of a triangle in a face of the box), and the component of the solid in that face which it bounds.
  struct ArcPart {
    std::uint32_t triangle;
    std::uint32_t part;
    [[nodiscard]] friend auto operator<=>(const ArcPart&, const ArcPart&) = default;
  };

  /// Finds the pieces, and adds each arc with its piece and part to `components`.
  /// @param triangles  all triangles that meet the box, and perhaps others.
  /// @param arcs  all arcs in the faces of the box.
  /// @param passing  the edges of the mesh that pass through these faces. An edge may occur more than once.
  void find(const SurfaceMesh& mesh, const BoxCell& box, std::span<const std::uint32_t> triangles,
            std::span<const ArcPart> arcs, std::span<const std::uint32_t> passing, CubeComponents& components);

  /// Returns the triangles that meet the open box, in ascending order.
  [[nodiscard]] std::span<const std::uint32_t> triangles() const { return triangles_; }
  /// Returns vertices minus edges plus triangles of a piece, each counted if it meets the open box.
  [[nodiscard]] std::int64_t euler(std::uint32_t piece) const { return euler_[piece]; }
  /// Returns true if a void, or a body with a tunnel, lies wholly inside the box.
  [[nodiscard]] bool holds_void() const { return holds_void_; }
  /// Returns the vertices of all bodies without tunnels that lie wholly inside the box, in ascending order.
  [[nodiscard]] std::span<const std::uint32_t> bodies() const { return bodies_; }

 private:
  void find_met(const SurfaceMesh& mesh, const BoxCell& box, std::span<const std::uint32_t> triangles,
                std::span<const ArcPart> arcs, std::span<const std::uint32_t> passing);
  void join(const SurfaceMesh& mesh);

  std::vector<std::uint32_t> triangles_, edges_, vertices_;  ///< those that meet the open box, ascending
  UnionFind joined_;                                         ///< over all of these, in this order
  std::vector<std::int64_t> euler_;
  std::vector<bool> is_open_;
  std::vector<bool> is_outer_;
  bool holds_void_ = false;
  std::vector<std::uint32_t> bodies_;
};

}  // namespace blum::detail
