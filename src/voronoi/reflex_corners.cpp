#include "voronoi/reflex_corners.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "blum/geometry/orient3d.hpp"
#include "voronoi/dual_cone.hpp"
#include "voronoi/edges_of_vertices.hpp"
#include "voronoi/label_geometry.hpp"

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

/// Two reflex edges and flat ones: all faces there lie in two planes, and the edges in the line in which these meet.
std::optional<ReflexCorner> passing_corner(std::uint32_t v, std::span<const std::uint32_t> edges,
                                           const PolyhedronSites& sites, const LabelGeometry& labels) {
  std::vector<std::uint32_t> bent;
  for (const std::uint32_t edge : edges) {
    if (sites.turn[edge] != EdgeTurn::flat) bent.push_back(edge);
  }
  if (bent.size() != 2 || labels.site_of_vertex(v)) return std::nullopt;
  ReflexCorner out;
  out.is_passing = true;
  const auto [first, second] = sites.triangles_of[bent[0]];
  out.faces = {sites.face_of[first], sites.face_of[second]};
  if (out.faces[0] == out.faces[1]) return std::nullopt;
  for (const std::uint32_t edge : bent) {
    const std::optional<std::uint32_t> site = labels.site_of_edge(edge);
    if (!site) return std::nullopt;
    out.edges.push_back(*site);
    out.rays.push_back({labels[first].direction, labels[second].direction});
  }
  return out;
}

/// The dual cone of a vertex's edges.
struct Cone {
  std::vector<std::uint32_t> edges;  ///< that hold facets, in the order around it
  std::vector<Vec3d> rays;           ///< of length 1; ray k lies between facets k and k + 1
};

Cone cone_at(std::uint32_t v, std::span<const std::uint32_t> edges, const MeshView& mesh, const SiteTable& table) {
  const std::vector<Vec3d> ends = far_ends(mesh, table, v, edges);
  Vec3d against;
  for (const Vec3d& end : ends) against -= unit(end - mesh.vertices[v]);
  const std::vector<std::uint32_t> bounds = facets(mesh.vertices[v], ends);
  Cone out;
  for (std::size_t k = 0; k < bounds.size(); ++k) {
    const Vec3d normal = unit_normal(mesh.vertices[v], ends[bounds[k]], ends[bounds[(k + 1) % bounds.size()]]);
    out.edges.push_back(edges[bounds[k]]);
    out.rays.push_back(dot(normal, against) > 0 ? normal : -normal);
  }
  return out;
}

std::optional<ReflexCorner> thin_corner(const Cone& cone, std::span<const std::uint32_t> edges,
                                        const PolyhedronSites& sites, const LabelGeometry& labels) {
  ReflexCorner out;
  out.is_thin = true;
  out.rays.push_back({cone.rays.front(), cone.rays.front()});
  for (const std::uint32_t edge : edges) {
    if (sites.turn[edge] == EdgeTurn::convex) return std::nullopt;
    if (const std::optional<std::uint32_t> site = labels.site_of_edge(edge)) out.edges.push_back(*site);
  }
  return out;
}

ReflexCorner corner_of(const Cone& cone, const PolyhedronSites& sites, const LabelGeometry& labels) {
  ReflexCorner out;
  const std::size_t count = cone.edges.size();
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t edge = cone.edges[k];
    const std::uint32_t next = cone.edges[(k + 1) % count];
    const std::optional<std::uint32_t> site = labels.site_of_edge(edge);
    if (!site) continue;
    out.edges.push_back(*site);
    out.rays.push_back({cone.rays[(k + count - 1) % count], cone.rays[k]});
    if (!labels.site_of_edge(next)) continue;
    for (const std::uint32_t t : sites.triangles_of[edge]) {
      for (const std::uint32_t u : sites.triangles_of[next]) {
        if (sites.face_of[t] == sites.face_of[u]) out.faces.push_back(sites.face_of[t]);
      }
    }
  }
  return out;
}

}  // namespace

std::vector<ReflexCorner> reflex_corners(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites,
                                         const LabelGeometry& labels) {
  std::vector<ReflexCorner> out(table.vertex_count());
  const IndexRows edges_of = edges_of_vertices(table);
  for (std::uint32_t v = 0; v < out.size(); ++v) {
    if (auto passing = passing_corner(v, edges_of[v], sites, labels)) out[v] = std::move(*passing);
  }
  for (const std::uint32_t v : sites.reflex_vertices) {
    const Cone cone = cone_at(v, edges_of[v], mesh, table);
    if (labels.site_of_vertex(v)) {
      out[v] = corner_of(cone, sites, labels);
    } else if (auto thin = thin_corner(cone, edges_of[v], sites, labels)) {
      out[v] = std::move(*thin);
    }
  }
  return out;
}

}  // namespace blum::voronoi
