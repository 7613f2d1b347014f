#include "voronoi/reflex_corners.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

#include "voronoi/dual_cone.hpp"
#include "voronoi/edges_of_vertices.hpp"

namespace blum::voronoi {

std::vector<ReflexCorner> reflex_corners(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites,
                                         const LabelGeometry& labels) {
  std::vector<ReflexCorner> out(table.vertex_count());
  const EdgesOfVertices edges_of(table);
  for (const std::uint32_t v : sites.reflex_vertices) {
    if (!labels.site_of_vertex(v)) continue;
    ReflexCorner& corner = out[v];
    const std::span<const std::uint32_t> edges = edges_of.of(v);
    corner.all_reflex = std::all_of(edges.begin(), edges.end(),
                                    [&](std::uint32_t edge) { return sites.turn[edge] != EdgeTurn::convex; });
    std::vector<Vec3d> ends;
    for (const std::uint32_t edge : edges) {
      const Segment& of = table.edges()[edge];
      ends.push_back(mesh.vertices[of[0] == v ? of[1] : of[0]]);
    }
    const std::vector<std::uint32_t> bounds = dual_cone(mesh.vertices[v], ends);
    for (std::size_t k = 0; k < bounds.size(); ++k) {
      const std::uint32_t edge = edges[bounds[k]];
      const std::uint32_t next = edges[bounds[(k + 1) % bounds.size()]];
      const std::optional<std::uint32_t> site = labels.site_of_edge(edge);
      if (!site) continue;
      corner.edges.push_back(*site);
      if (!labels.site_of_edge(next)) continue;
      for (const std::uint32_t t : sites.triangles_of[edge]) {
        for (const std::uint32_t u : sites.triangles_of[next]) {
          if (sites.face_of[t] == sites.face_of[u]) corner.faces.push_back(sites.face_of[t]);
        }
      }
    }
  }
  return out;
}

}  // namespace blum::voronoi
