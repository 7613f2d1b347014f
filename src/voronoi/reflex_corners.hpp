// Blum: walls and lines that end at reflex vertices. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/complex/index_rows.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"
#include "voronoi/label_geometry.hpp"

namespace blum::voronoi {

/// The edges of a SiteTable at each of its vertices, in rising order.
[[nodiscard]] inline IndexRows edges_of_vertices(const SiteTable& table) {
  return detail::rows_of(table.edge_count(), table.vertex_count(),
                         [&](std::size_t edge) -> const Segment& { return table.edges()[edge]; });
}

/// Where edges at a vertex end.
[[nodiscard]] inline std::vector<Vec3d> far_ends(const MeshView& mesh, const SiteTable& table, std::uint32_t v,
                                                 std::span<const std::uint32_t> edges) {
  std::vector<Vec3d> out;
  for (const std::uint32_t edge : edges) {
    const auto& [a, b] = table.edges()[edge];
    out.push_back(mesh.vertices[a == v ? b : a]);
  }
  return out;
}

/// What ends at a vertex v that is a site, or in which two reflex edges in one line meet (a passing vertex).
///
/// Next to a vertex v the diagram is a cone. The region of v is bounded there by walls between
/// it and some of its edges, one for each facet of the dual cone; these meet in rays of the cone, of which some are
/// normals of faces. A passing vertex has no region: between both edges lies a wall, in the plane across them. The
/// region of a thin vertex counts as a line; that of one around which all edges are reflex is a line around which all
/// walls are dropped.
struct ReflexCorner {
  std::vector<std::uint32_t> edges;  ///< sites
  /// Directions of length 1, of the two rays between which each of their facets lies.
  std::vector<std::array<Vec3d, 2>> rays;
  std::vector<std::uint32_t> faces;  ///< sites, of the normals
  bool is_passing = false;           ///< then there are two edges, and two faces
  bool is_thin = false;  ///< then its edges are reflex or flat, the first ones are listed, no faces, and a ray twice

  /// Into how many parts the medial axis falls next to v: around v, walls that are kept are a forest, and Euler's
  /// formula counts its trees. None where all edges are reflex; more than one only meet in v.
  [[nodiscard]] std::int64_t axis_parts() const {
    if (is_passing || is_thin) return 0;
    return static_cast<std::int64_t>(edges.size()) - static_cast<std::int64_t>(faces.size());
  }
};

/// That of each vertex of a mesh, empty where it is neither, or a thin vertex with convex edges.
[[nodiscard]] std::vector<ReflexCorner> reflex_corners(const MeshView& mesh, const SiteTable& table,
                                                       const PolyhedronSites& sites, const LabelGeometry& labels);

}  // namespace blum::voronoi
