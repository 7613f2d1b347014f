// Blum: walls and lines that end at reflex vertices. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"
#include "voronoi/label_geometry.hpp"

namespace blum::voronoi {

/// What ends at a reflex vertex v, next to which the diagram is a cone. The region of v is bounded there by walls between
/// it and some of its edges, one for each facet of the dual cone; these meet in rays of the cone, of which some are
/// normals of faces.
struct ReflexCorner {
  std::vector<std::uint32_t> edges;  ///< sites
  std::vector<std::uint32_t> faces;  ///< sites, of the normals
  bool all_reflex = false;           ///< whether all edges that are not flat are reflex
};

/// That of each vertex of a mesh, empty where it is no site or a thin one.
[[nodiscard]] std::vector<ReflexCorner> reflex_corners(const MeshView& mesh, const SiteTable& table,
                                                       const PolyhedronSites& sites, const LabelGeometry& labels);

}  // namespace blum::voronoi
