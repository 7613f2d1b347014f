#include "blum/voronoi/voronoi_sites.hpp"

#include "blum/voronoi/polyhedron_sites.hpp"

namespace blum {

std::vector<VoronoiSite> voronoi_sites(const MeshView& mesh, const Context& context) {
  const SiteTable table(mesh, context);
  const PolyhedronSites sites = polyhedron_sites(mesh, table, context);
  std::vector<VoronoiSite> out(sites.face_count, {SiteKind::face, {}, {}});
  for (std::uint32_t t = 0; t < sites.face_of.size(); ++t) out[sites.face_of[t]].triangles.push_back(t);
  for (const std::uint32_t edge : sites.reflex_edges) {
    const auto& [a, b] = table.edges()[edge];
    out.push_back({SiteKind::edge, {}, {a, b}});
  }
  for (const std::uint32_t v : sites.reflex_vertices) out.push_back({SiteKind::vertex, {}, {v}});
  return out;
}

}  // namespace blum
