#include "surface_map/facing_surface.hpp"

#include <algorithm>
#include <numeric>

namespace blum::surface {
namespace {

/// Calls visit(site) for the vertices and edges of a primitive. A site may be visited more than once.
template <class Visit>
void for_each_border_site(const MeshView& mesh, const SiteTable& sites, std::uint32_t primitive, Visit visit) {
  const Triangle vertices = primitive_vertices(mesh, primitive);
  for (const std::uint32_t v : vertices) visit(std::size_t{v});
  const std::size_t edges_from = sites.vertex_count();
  if (primitive < mesh.triangles.size()) {
    for (const EdgeId edge : sites.triangle_edges()[primitive]) {
      if (edge.has_value()) visit(edges_from + edge.value);
    }
  } else if (vertices[0] != vertices[1]) {
    const Segment ends{std::min(vertices[0], vertices[1]), std::max(vertices[0], vertices[1])};
    const auto found = std::lower_bound(sites.edges().begin(), sites.edges().end(), ends);
    visit(edges_from + static_cast<std::size_t>(found - sites.edges().begin()));
  }
}

}  // namespace

FacingSurface::FacingSurface(const MeshView& mesh, const Context& context)
    : mesh_(mesh), sites_(mesh, context), bvh_(mesh, sites_, context) {
  const std::size_t borders = sites_.vertex_count() + sites_.edge_count();
  const auto count = static_cast<std::uint32_t>(primitive_count(mesh));
  first_.assign(borders + 1, 0);
  for (std::uint32_t p = 0; p < count; ++p) {
    for_each_border_site(mesh, sites_, p, [&](std::size_t site) { ++first_[site + 1]; });
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  primitives_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t p = 0; p < count; ++p) {
    for_each_border_site(mesh, sites_, p, [&](std::size_t site) { primitives_[next[site]++] = p; });
  }
  all_.resize(sites_.face_count());
  std::iota(all_.begin(), all_.end(), 0U);
}

std::span<const std::uint32_t> FacingSurface::primitives_at(SiteId site) const {
  const std::size_t borders = first_.size() - 1;
  if (site.value >= borders) return std::span(all_).subspan(site.value - borders, 1);
  return std::span(primitives_).subspan(first_[site.value], first_[site.value + 1] - first_[site.value]);
}

std::array<Vec3d, 3> FacingSurface::corners_of(std::uint32_t primitive) const {
  const Triangle v = vertices_of(primitive);
  return {position(v[0]), position(v[1]), position(v[2])};
}

}  // namespace blum::surface
