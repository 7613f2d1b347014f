// Blum: walls and lines that end at reflex vertices. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"
#include "voronoi/label_geometry.hpp"

namespace blum::voronoi {

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
