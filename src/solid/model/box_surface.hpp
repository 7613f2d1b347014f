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

/// Returns true if the box around a triangle meets a box; both are closed.
[[nodiscard]] bool may_meet(const TriangleCorners& triangle, const Vec3d& low, const Vec3d& high);
/// Same test, but also false if a plane along the triangle, or along one of its edges and an axis, certainly separates
/// the two. The box around a slanted needle meets much that the needle does not.
[[nodiscard]] bool may_reach(const TriangleCorners& t, const Vec3d& low, const Vec3d& high);

/// Returns true if a triangle crosses the part of a line along an axis between two points. Exact.
[[nodiscard]] bool crosses(const TriangleCorners& triangle, std::size_t axis, const Vec3d& low, const Vec3d& high);

/// Sorts triangles that cross a line along an axis through a point from below. Exact.
void sort_along(const SurfaceMesh& mesh, std::size_t axis, const Vec3d& on_line, std::vector<std::uint32_t>& triangles);

/// Returns true if an edge of a mesh passes through the rectangle across an axis between two corners. Exact.
[[nodiscard]] bool passes_through(const EdgeEnds& edge, std::size_t across, const Vec3d& low, const Vec3d& high);

/// Returns true if a point lies between the planes of a box. The lower planes belong to the box. Exact.
[[nodiscard]] bool is_in_box(const Vec3d& p, const BoxCell& box);

/// The pieces of a surface in an open box. Reusable.
class BoxPieces {
 public:
  /// An arc of a triangle on a component of the solid in a side of the box.
  struct ArcPart {
    std::uint32_t triangle;
    std::uint32_t part;
    [[nodiscard]] friend auto operator<=>(const ArcPart&, const ArcPart&) = default;
  };

  /// Finds the pieces, and passes to CubeComponents the parts that have arcs on them.
  /// @param triangles  all that meet the box, and perhaps others.
  /// @param arcs  all in the sides of the box.
  /// @param passing  the edges of the mesh that pass these sides; an edge may occur more than once.
  void find(const SurfaceMesh& mesh, const BoxCell& box, std::span<const std::uint32_t> triangles,
            std::span<const ArcPart> arcs, std::span<const std::uint32_t> passing, CubeComponents& components);

  /// Returns the triangles that meet the open box, rising.
  [[nodiscard]] std::span<const std::uint32_t> triangles() const { return triangles_; }
  /// Returns vertices minus edges plus triangles of a piece passed to CubeComponents.
  [[nodiscard]] std::int64_t euler(std::uint32_t piece) const { return euler_[piece]; }
  /// Returns true if a void, or a body with a tunnel, lies wholly inside.
  [[nodiscard]] bool holds_void() const { return holds_void_; }
  /// Returns a vertex of each body without tunnels that lies wholly inside, rising.
  [[nodiscard]] std::span<const std::uint32_t> bodies() const { return bodies_; }

 private:
  void find_met(const SurfaceMesh& mesh, const BoxCell& box, std::span<const std::uint32_t> triangles,
                std::span<const ArcPart> arcs, std::span<const std::uint32_t> passing);
  void join(const SurfaceMesh& mesh);

  std::vector<std::uint32_t> triangles_, edges_, vertices_;  ///< that meet the open box, rising
  UnionFind joined_;                                         ///< of all these, in this order
  std::vector<std::int64_t> euler_;
  std::vector<bool> is_open_;
  std::vector<bool> is_outer_;
  bool holds_void_ = false;
  std::vector<std::uint32_t> bodies_;
};

}  // namespace blum::detail
