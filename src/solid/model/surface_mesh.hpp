// Blum: the closed surface of a body, with neighbours. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/grid_predicates.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// A closed, manifold mesh that faces outwards and does not touch itself. The mesh must outlive it.
class SurfaceMesh {
 public:
  SurfaceMesh(const MeshView& mesh, const Context& context) : mesh_(mesh), sites_(mesh, context) {
    constexpr std::uint32_t nobody = 0xffffffffU;
    triangles_of_edge_.assign(sites_.edge_count(), {nobody, nobody});
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      for (const EdgeId edge : edges_of(t)) {
        auto& pair = triangles_of_edge_[edge.value];
        pair[pair[0] == nobody ? 0 : 1] = t;
      }
    }
  }

  [[nodiscard]] std::span<const Vec3d> vertices() const { return mesh_.vertices; }
  [[nodiscard]] std::span<const Triangle> triangles() const { return mesh_.triangles; }
  /// Vertex pairs, smaller vertex first.
  [[nodiscard]] std::span<const Segment> edges() const { return sites_.edges(); }
  /// Edge k lies between corners k and k + 1.
  [[nodiscard]] const std::array<EdgeId, 3>& edges_of(std::uint32_t triangle) const {
    return sites_.triangle_edges()[triangle];
  }
  /// The two triangles at an edge.
  [[nodiscard]] const std::array<std::uint32_t, 2>& triangles_of(std::uint32_t edge) const {
    return triangles_of_edge_[edge];
  }
  [[nodiscard]] TriangleCorners corners(std::uint32_t triangle) const {
    const Triangle& t = mesh_.triangles[triangle];
    return {mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]};
  }
  [[nodiscard]] EdgeEnds ends(std::uint32_t edge) const {
    const Segment& e = edges()[edge];
    return {mesh_.vertices[e[0]], mesh_.vertices[e[1]]};
  }

 private:
  MeshView mesh_;
  SiteTable sites_;
  std::vector<std::array<std::uint32_t, 2>> triangles_of_edge_;
};

}  // namespace blum::detail
