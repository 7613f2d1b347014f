// Blum: the closed surface of a body, with neighbours. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/grid_predicates.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// Returns the exponent for which 2^exponent scales the coordinate of largest magnitude of a box to at least 1/2 and
/// below 1.
[[nodiscard]] int scale_of(const Box3& box);

/// Returns a point multiplied by 2^exponent.
/// @param exponent  may be negative.
[[nodiscard]] inline Vec3d scaled(const Vec3d& p, int exponent) {
  return {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
}

/// Returns a mesh multiplied by 2^exponent.
/// @throws InvalidMesh if a coordinate becomes too small for exact predicates.
[[nodiscard]] TriangleMesh scaled(TriangleMesh mesh, int exponent);

/// A closed, manifold mesh of one or several bodies. The mesh faces outwards and does not touch itself. The given mesh
/// must outlive this object.
class SurfaceMesh {
 public:
  /// Makes the mesh of one body.
  SurfaceMesh(const MeshView& mesh, const Context& context)
      : SurfaceMesh(mesh, {outermost_vertex(mesh.vertices)}, context) {}
  /// @param outermost  one vertex of each body's outer shell, in ascending order.
  SurfaceMesh(const MeshView& mesh, std::vector<std::uint32_t> outermost, const Context& context)
      : mesh_(mesh), sites_(mesh, context), outermost_(std::move(outermost)) {
    constexpr std::uint32_t nobody = 0xffffffffU;
    triangles_of_edge_.assign(sites_.edge_count(), {nobody, nobody});
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      for (const EdgeId edge : edges_of(t)) {
        auto& pair = triangles_of_edge_[edge.value];
        pair[pair[0] == nobody ? 0 : 1] = t;
      }
    }
  }

  /// Returns the vertex with the largest x-coordinate. This vertex belongs to the outer shell of a body.
  [[nodiscard]] static std::uint32_t outermost_vertex(std::span<const Vec3d> vertices) {
    const auto at =
        std::max_element(vertices.begin(), vertices.end(), [](const Vec3d& a, const Vec3d& b) { return a.x < b.x; });
    return static_cast<std::uint32_t>(at - vertices.begin());
  }
  /// Returns one vertex of each body's outer shell, in ascending order.
  [[nodiscard]] std::span<const std::uint32_t> outermost() const { return outermost_; }

  [[nodiscard]] std::span<const Vec3d> vertices() const { return mesh_.vertices; }
  [[nodiscard]] std::span<const Triangle> triangles() const { return mesh_.triangles; }
  /// Returns the edges as pairs of vertices, the smaller vertex first.
  [[nodiscard]] std::span<const Segment> edges() const { return sites_.edges(); }
  /// Returns the edges of a triangle. Edge k lies between corners k and k + 1.
  [[nodiscard]] const std::array<EdgeId, 3>& edges_of(std::uint32_t triangle) const {
    return sites_.triangle_edges()[triangle];
  }
  /// Returns the two triangles at an edge.
  [[nodiscard]] const std::array<std::uint32_t, 2>& triangles_of(std::uint32_t edge) const {
    return triangles_of_edge_[edge];
  }
  [[nodiscard]] TriangleCorners corners(std::uint32_t triangle) const { return triangle_corners(mesh_, triangle); }
  [[nodiscard]] EdgeEnds ends(std::uint32_t edge) const {
    const Segment& e = edges()[edge];
    return {mesh_.vertices[e[0]], mesh_.vertices[e[1]]};
  }

 private:
  MeshView mesh_;
  SiteTable sites_;
  std::vector<std::uint32_t> outermost_;
  std::vector<std::array<std::uint32_t, 2>> triangles_of_edge_;
};

}  // namespace blum::detail
