// Blum: sites of a polyhedron by their numbers in Voronoi diagrams. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/voronoi/voronoi_complex.hpp"

namespace blum {

template <>
struct Description<SiteKind> {
  static constexpr std::string_view name = "SiteKind";
  static constexpr std::array values{NamedValue{SiteKind::vertex, "vertex"}, NamedValue{SiteKind::edge, "edge"},
                                     NamedValue{SiteKind::face, "face"}};
};

/// Face, reflex edge or reflex vertex of a polyhedron. A face lists its triangles in the mesh. An edge or vertex lists
/// its vertices.
struct VoronoiSite {
  SiteKind kind = SiteKind::face;
  std::vector<std::uint32_t> triangles;  ///< For a face: its coplanar triangles, ascending. Otherwise empty.
  /// For an edge: its two vertices, the smaller index first. For a vertex: the vertex. For a face: empty.
  std::vector<std::uint32_t> vertices;
};

template <>
struct Description<VoronoiSite> {
  static constexpr std::string_view name = "VoronoiSite";
  static constexpr std::string_view doc = "Face, reflex edge or reflex vertex of a polyhedron";
  static constexpr std::tuple members{
      Member{"kind", &VoronoiSite::kind, "", "face, edge or vertex"},
      Member{"triangles", &VoronoiSite::triangles, "", "triangles of a face"},
      Member{"vertices", &VoronoiSite::vertices, "",
             "vertices of the mesh: the two ends of an edge, or the one vertex"},
  };
};

/// Returns the sites of a polyhedron. Site k has the number k in `site_a` and `site_b` of voronoi_complex(), and in
/// VoronoiRegion::site. Faces come first, by their smallest triangle, then reflex edges by their vertices, then reflex
/// vertices.
/// @throws as polyhedron_sites().
/// Cost: that of polyhedron_sites().
[[nodiscard]] std::vector<VoronoiSite> voronoi_sites(const MeshView& mesh, const Context& context = {});

/// Returns the sites of a result of voronoi_complex(). If faces were joined (VoronoiReport::joined_faces), the face
/// with the smallest number has the triangles of all joined faces. The other joined faces have no triangles. Edges and
/// vertices inside joined faces stay in the list, although they have no regions.
/// @param report  of a complex of this mesh.
/// @throws as polyhedron_sites(); InvalidOption if the report has faces that the mesh does not have.
[[nodiscard]] std::vector<VoronoiSite> voronoi_sites(const MeshView& mesh, const VoronoiReport& report,
                                                     const Context& context = {});

}  // namespace blum
