#include "certificate/stated_sites.hpp"

#include <algorithm>
#include <utility>

#include "blum/core/union_find.hpp"
#include "blum/geometry/orient3d.hpp"
#include "certificate/triangle_search.hpp"

namespace blum::verifier {
namespace {

/// Returns the corner of a triangle that is not on an edge.
std::uint32_t apex(const Triangle& triangle, const Segment& edge) {
  for (const std::uint32_t v : triangle) {
    if (v != edge[0] && v != edge[1]) return v;
  }
  return triangle[0];
}

}  // namespace

StatedSites::StatedSites(const MeshView& mesh, const SiteTable& sites, const ClosedShells& shells,
                         const SurfaceWalls& walls)
    : sites_(sites), walls_(walls), first_of_vertex_(mesh.vertices.size() + 1, 0) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  detail::UnionFind faces(count);
  std::vector<std::uint32_t> reflex;
  for (std::uint32_t side = 0; side < 3 * count; ++side) {
    const std::uint32_t t = side / 3;
    const std::uint32_t other = shells.beside[side];
    if (shells.of_triangle[t] == no_group || t > other) continue;
    const EdgeId edge = sites.triangle_edges()[t][side % 3];
    const auto& [a, b, c] = corners_of(mesh, t);
    const Vec3d& d = mesh.vertices[apex(mesh.triangles[other], sites.edges()[edge.value])];
    const int turn = detail::orient3d(a, b, c, d) * shells.outwards[t];
    const bool is_void = shells.shells[shells.of_triangle[t]].depth % 2 == 1;
    if (turn == 0) {
      faces.join(t, other);
    } else if ((turn > 0) != is_void) {
      reflex.push_back(edge.value);
    }
  }
  for (std::uint32_t t = 0; t < count; ++t) {
    if (faces.find(t) == t) first_of_face_.push_back(t);
    for (const std::uint32_t v : mesh.triangles[t]) ++first_of_vertex_[v + 1];
  }
  std::sort(reflex.begin(), reflex.end());
  for (const std::uint32_t edge : reflex) reflex_edges_.push_back({sites.edges()[edge][0], sites.edges()[edge][1]});
  for (std::size_t v = 1; v < first_of_vertex_.size(); ++v) first_of_vertex_[v] += first_of_vertex_[v - 1];
  at_vertices_.resize(3 * std::size_t{count});
  std::vector<std::size_t> next(first_of_vertex_.begin(), first_of_vertex_.end() - 1);
  for (std::uint32_t t = 0; t < count; ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) at_vertices_[next[v]++] = t;
  }
}

template <class Visit>
bool StatedSites::any_triangle(SiteId site, const Visit& visit) const {
  const Site own = sites_.site(site);
  if (own.kind == SiteKind::face) return visit(own.index);
  const auto v = static_cast<std::size_t>(sites_.vertices(site)[0]);
  for (std::size_t k = first_of_vertex_[v]; k < first_of_vertex_[v + 1]; ++k) {
    const std::uint32_t t = at_vertices_[k];
    const auto& edges = sites_.triangle_edges()[t];
    const bool is_at = own.kind == SiteKind::vertex || std::any_of(edges.begin(), edges.end(), [&](EdgeId edge) {
                         return edge.has_value() && edge.value == own.index;
                       });
    if (is_at && visit(t)) return true;
  }
  return false;
}

bool StatedSites::may_contain(std::int64_t number, SiteId site) const {
  if (!site.has_value() || site.value >= sites_.size() || number < 0) return false;
  const auto n = static_cast<std::size_t>(number);
  if (n < first_of_face_.size()) {
    const std::uint32_t part = walls_.flat_part_of(first_of_face_[n]);
    return any_triangle(site, [&](std::uint32_t t) { return walls_.flat_part_of(t) == part; });
  }
  if (n - first_of_face_.size() >= reflex_edges_.size()) return true;
  const auto& ends = reflex_edges_[n - first_of_face_.size()];
  const auto vertices = sites_.vertices(site);
  return std::any_of(vertices.begin(), vertices.end(), [&](std::int32_t v) {
    return v >= 0 && (static_cast<std::uint32_t>(v) == ends[0] || static_cast<std::uint32_t>(v) == ends[1]);
  });
}

}  // namespace blum::verifier
