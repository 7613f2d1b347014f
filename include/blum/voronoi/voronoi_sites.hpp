// Blum: the sites of a polyhedron by the numbers that Voronoi diagrams have. SPDX-License-Identifier: Apache-2.0
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

namespace blum {

template <>
struct Description<SiteKind> {
  static constexpr std::string_view name = "SiteKind";
  static constexpr std::array values{NamedValue{SiteKind::vertex, "vertex"}, NamedValue{SiteKind::edge, "edge"},
                                     NamedValue{SiteKind::face, "face"}};
};

/// A face, reflex edge or reflex vertex of a polyhedron: what it is of the mesh.
struct VoronoiSite {
  SiteKind kind = SiteKind::face;
  std::vector<std::uint32_t> triangles;  ///< of a face, rising: coplanar ones that share edges
  std::vector<std::uint32_t> vertices;   ///< of an edge both ends, the smaller one first; of a vertex itself
};

template <>
struct Description<VoronoiSite> {
  static constexpr std::string_view name = "VoronoiSite";
  static constexpr std::string_view doc = "A face, reflex edge or reflex vertex of a polyhedron";
  static constexpr std::tuple members{
      Member{"kind", &VoronoiSite::kind, "", "face, edge or vertex"},
      Member{"triangles", &VoronoiSite::triangles, "", "of the mesh: those of a face"},
      Member{"vertices", &VoronoiSite::vertices, "", "of the mesh: both ends of an edge; a vertex"},
  };
};

/// Site k of the list is number k of `site_a` and `site_b` in the complexes of voronoi_complex(), and of
/// VoronoiRegion::site: faces by their smallest triangle, then reflex edges by their vertices, then reflex vertices.
/// @throws as polyhedron_sites(). Cost: its own.
[[nodiscard]] std::vector<VoronoiSite> voronoi_sites(const MeshView& mesh, const Context& context = {});

}  // namespace blum
