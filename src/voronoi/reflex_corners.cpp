#include "voronoi/reflex_corners.hpp"

#include <cstddef>
#include <span>

#include "blum/geometry/orient3d.hpp"
#include "voronoi/dual_cone.hpp"
#include "voronoi/edges_of_vertices.hpp"
#include "voronoi/unit_normal.hpp"

namespace blum::voronoi {
namespace {

/// The constraints that hold facets of a dual cone, in the order around it: not those that touch it in a ray.
std::vector<std::uint32_t> facets(const Vec3d& v, std::span<const Vec3d> ends) {
  std::vector<std::uint32_t> out = dual_cone(v, ends);
  for (std::size_t k = 0; k < out.size() && out.size() > 3;) {
    const Vec3d& before = ends[out[(k + out.size() - 1) % out.size()]];
    const Vec3d& behind = ends[out[(k + 1) % out.size()]];
    if (detail::orient3d(v, before, ends[out[k]], behind) != 0) {
      ++k;
    } else {
      out.erase(out.begin() + static_cast<std::ptrdiff_t>(k));
      k = 0;
    }
  }
  return out;
}

}  // namespace

std::vector<ReflexCorner> reflex_corners(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites,
                                         const LabelGeometry& labels) {
  std::vector<ReflexCorner> out(table.vertex_count());
  const EdgesOfVertices edges_of(table);
  for (const std::uint32_t v : sites.reflex_vertices) {
    if (!labels.site_of_vertex(v)) continue;
    ReflexCorner& corner = out[v];
    const std::span<const std::uint32_t> edges = edges_of.of(v);
    std::vector<Vec3d> ends;
    for (const std::uint32_t edge : edges) {
      const Segment& of = table.edges()[edge];
      ends.push_back(mesh.vertices[of[0] == v ? of[1] : of[0]]);
    }
    const std::vector<std::uint32_t> bounds = facets(mesh.vertices[v], ends);
    Vec3d against;
    for (const Vec3d& end : ends) against -= unit(end - mesh.vertices[v]);
    const auto ray = [&](std::size_t k) {
      const Vec3d normal = unit_normal(mesh.vertices[v], ends[bounds[k % bounds.size()]],
                                       ends[bounds[(k + 1) % bounds.size()]]);
      return dot(normal, against) > 0 ? normal : -normal;
    };
    for (std::size_t k = 0; k < bounds.size(); ++k) {
      const std::uint32_t edge = edges[bounds[k]];
      const std::uint32_t next = edges[bounds[(k + 1) % bounds.size()]];
      const std::optional<std::uint32_t> site = labels.site_of_edge(edge);
      if (!site) continue;
      corner.edges.push_back(*site);
      corner.rays.push_back({ray(k + bounds.size() - 1), ray(k)});
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
