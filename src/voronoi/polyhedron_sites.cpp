#include "blum/voronoi/polyhedron_sites.hpp"

#include <algorithm>
#include <string>

#include "blum/core/error.hpp"
#include "blum/core/gather.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/union_find.hpp"
#include "blum/geometry/orient3d.hpp"
#include "blum/voronoi/voronoi_sites.hpp"
#include "voronoi/dual_cone.hpp"
#include "voronoi/site_labels.hpp"

namespace blum {
namespace {

constexpr std::size_t edges_per_range = 1024;
constexpr std::size_t vertices_per_range = 64;
constexpr std::uint32_t nobody = 0xffffffff;

void check_areas(const MeshView& mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = triangle_corners(mesh, t);
    if (voronoi::are_collinear(a, b, c)) {
      throw InvalidMesh("triangle " + std::to_string(t) + " has no area; a polyhedron's faces must have one");
    }
  }
}

/// Returns the two triangles of each edge. The first triangle traverses the edge from the smaller to the larger vertex.
std::vector<std::array<std::uint32_t, 2>> triangles_of_edges(const MeshView& mesh, const SiteTable& sites) {
  std::vector<std::array<std::uint32_t, 2>> out(sites.edge_count(), {nobody, nobody});
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t edge = sites.triangle_edges()[t][k].value;
      const bool is_first = mesh.triangles[t][k] < mesh.triangles[t][(k + 1) % 3];
      std::uint32_t& place = out[edge][is_first ? 0 : 1];
      if (place != nobody) {
        throw InvalidMesh("two triangles, " + std::to_string(place) + " and " + std::to_string(t) +
                          ", traverse an edge in the same direction; in a polyhedron, the directions are opposite");
      }
      place = t;
    }
  }
  for (std::size_t edge = 0; edge < out.size(); ++edge) {
    if (out[edge][0] != nobody && out[edge][1] != nobody) continue;
    const auto [a, b] = sites.edges()[edge];
    throw InvalidMesh("the edge between vertices " + std::to_string(a) + " and " + std::to_string(b) +
                      " does not have two triangles; a polyhedron is closed");
  }
  return out;
}

EdgeTurn turn_of(const MeshView& mesh, const Segment& ends, const std::array<std::uint32_t, 2>& triangles) {
  const auto apex = [&](std::uint32_t t) {
    const Triangle& corners = mesh.triangles[t];
    for (const std::uint32_t v : corners) {
      if (v != ends[0] && v != ends[1]) return mesh.vertices[v];
    }
    return mesh.vertices[ends[0]];
  };
  const Vec3d& a = mesh.vertices[ends[0]];
  const Vec3d& b = mesh.vertices[ends[1]];
  const int side = detail::orient3d(a, b, apex(triangles[0]), apex(triangles[1]));
  return side > 0 ? EdgeTurn::reflex : side < 0 ? EdgeTurn::convex : EdgeTurn::flat;
}

void number_faces(const MeshView& mesh, PolyhedronSites& out) {
  detail::UnionFind faces(mesh.triangles.size());
  for (std::size_t edge = 0; edge < out.turn.size(); ++edge) {
    if (out.turn[edge] == EdgeTurn::flat) faces.join(out.triangles_of[edge][0], out.triangles_of[edge][1]);
  }
  out.face_of.resize(mesh.triangles.size());
  for (std::uint32_t t = 0; t < out.face_of.size(); ++t) {
    const std::uint32_t smallest = faces.find(t);
    out.face_of[t] = smallest == t ? static_cast<std::uint32_t>(out.face_count++) : out.face_of[smallest];
  }
}

/// Returns true if a vertex is the closest site to a cone of points inside the solid.
bool is_reflex_vertex(const MeshView& mesh, const SiteTable& sites, const PolyhedronSites& found, std::uint32_t v,
                      std::span<const std::uint32_t> edges) {
  const auto is_reflex = [&](std::uint32_t edge) { return found.turn[edge] == EdgeTurn::reflex; };
  if (std::none_of(edges.begin(), edges.end(), is_reflex)) return false;
  const std::vector<Vec3d> ends = voronoi::far_ends(mesh, sites, v, edges);
  // Flat edges that bound the cone decide nothing. All other edges that bound it are reflex, or all are convex.
  for (const std::uint32_t k : voronoi::dual_cone(mesh.vertices[v], ends)) {
    if (found.turn[edges[k]] != EdgeTurn::flat) return found.turn[edges[k]] == EdgeTurn::reflex;
  }
  return false;
}

}  // namespace

PolyhedronSites polyhedron_sites(const MeshView& mesh, const SiteTable& sites, const Context& context) {
  validate(mesh);
  check_areas(mesh);
  PolyhedronSites out;
  out.triangles_of = triangles_of_edges(mesh, sites);
  out.turn.resize(sites.edge_count());
  parallel_for(context, out.turn.size(), edges_per_range, "sites", [&](const WorkRange& range) {
    for (std::size_t edge = range.begin; edge < range.end; ++edge) {
      out.turn[edge] = turn_of(mesh, sites.edges()[edge], out.triangles_of[edge]);
    }
  });
  number_faces(mesh, out);
  for (std::uint32_t edge = 0; edge < out.turn.size(); ++edge) {
    if (out.turn[edge] == EdgeTurn::reflex) out.reflex_edges.push_back(edge);
  }
  const IndexRows edges = voronoi::edges_of_vertices(sites);
  out.reflex_vertices = detail::gather<std::uint32_t>(context, mesh.vertices.size(), vertices_per_range, "sites",
                                                      [&](std::size_t v, std::vector<std::uint32_t>& list) {
                                                        const auto vertex = static_cast<std::uint32_t>(v);
                                                        if (is_reflex_vertex(mesh, sites, out, vertex, edges[v]))
                                                          list.push_back(vertex);
                                                      });
  return out;
}

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

std::vector<VoronoiSite> voronoi_sites(const MeshView& mesh, const VoronoiReport& report, const Context& context) {
  std::vector<VoronoiSite> out = voronoi_sites(mesh, context);
  for (const auto& [from, to] : report.joined_faces) {
    if (from >= out.size() || to >= out.size()) {
      throw InvalidOption("voronoi_sites(): the report joins face " + std::to_string(std::max(from, to)) +
                          ", but the mesh has " + std::to_string(out.size()) + " sites: pass the mesh of the complex");
    }
    std::vector<std::uint32_t>& all = out[to].triangles;
    all.insert(all.end(), out[from].triangles.begin(), out[from].triangles.end());
    std::sort(all.begin(), all.end());
    out[from].triangles.clear();
  }
  return out;
}

}  // namespace blum
