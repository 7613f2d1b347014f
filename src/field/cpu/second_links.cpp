#include "field/cpu/second_links.hpp"

#include <algorithm>

#include "blum/core/parallel.hpp"
#include "field/cpu/record_build.hpp"

namespace blum::cpu {
namespace {

using kernels::to_float;

constexpr std::size_t grain = 1 << 12;

/// For each vertex: the edges opposite to it in its triangles.
struct Opposite {
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> edges;
};

/// Calls visit(vertex, opposite edge) for every corner of the triangles with three different vertices.
template <class Visit>
void for_each_opposite(const MeshView& mesh, const SiteTable& sites, const Visit& visit) {
  const auto edges = sites.triangle_edges();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& of_triangle = edges[t];
    if (!of_triangle[0].has_value() || !of_triangle[1].has_value() || !of_triangle[2].has_value()) continue;
    for (std::size_t k = 0; k < 3; ++k) visit(mesh.triangles[t][(k + 2) % 3], of_triangle[k].value);
  }
}

Opposite find_opposite(const MeshView& mesh, const SiteTable& sites) {
  Opposite out;
  out.first.assign(mesh.vertices.size() + 1, 0);
  for_each_opposite(mesh, sites, [&](std::uint32_t vertex, std::uint32_t) { ++out.first[vertex + 1]; });
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) out.first[v + 1] += out.first[v];
  out.edges.resize(out.first.back());
  std::vector<std::uint32_t> next(out.first.begin(), out.first.end() - 1);
  for_each_opposite(mesh, sites, [&](std::uint32_t vertex, std::uint32_t edge) { out.edges[next[vertex]++] = edge; });
  return out;
}

/// Returns true if a vertex's link must list `neighbour` as a point. In this case, some site may contain the vertex and
/// touch all edges of the link that end at `neighbour`, but not contain `neighbour`.
/// @param link  the edges of the link, by both ends: (neighbour, other end), sorted.
bool needs_point(const std::vector<Segment>& link, std::uint32_t neighbour) {
  const auto first = std::lower_bound(link.begin(), link.end(), Segment{neighbour, 0});
  std::uint32_t others[2] = {};
  std::size_t count = 0;
  for (auto at = first; at != link.end() && (*at)[0] == neighbour; ++at) {
    if (count > 0 && (*at)[1] == others[count - 1]) continue;
    if (count == 2) return false;  // besides the vertex, a site has at most two vertices
    others[count++] = (*at)[1];
  }
  if (count < 2) return true;
  // True if a triangle has all three vertices.
  return std::binary_search(link.begin(), link.end(), Segment{others[0], others[1]});
}

}  // namespace

void build_link_entries(const MeshView& mesh, const SiteTable& sites, const Adjacency& adjacency,
                        const Context& context, SecondLinks& out) {
  const Opposite opposite = find_opposite(mesh, sites);
  throw_if_cancelled(context);
  const std::size_t vertices = mesh.vertices.size();
  out.first.assign(1, 0);
  out.first.reserve(vertices + 1);
  out.entries.clear();
  out.entries.reserve(opposite.edges.size());
  std::vector<Segment> link;
  std::vector<std::uint32_t> own;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    own.assign(opposite.edges.begin() + opposite.first[v], opposite.edges.begin() + opposite.first[v + 1]);
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    link.clear();
    for (const std::uint32_t edge : own) {
      const Segment& ends = sites.edges()[edge];
      link.push_back(ends);
      link.push_back({ends[1], ends[0]});
      out.entries.push_back({edge, ends[0], ends[1]});
    }
    std::sort(link.begin(), link.end());
    for (std::size_t k = adjacency.first_neighbour[v]; k < adjacency.first_neighbour[v + 1]; ++k) {
      const std::uint32_t neighbour = adjacency.neighbours[k];
      if (needs_point(link, neighbour)) {
        out.entries.push_back({static_cast<std::uint32_t>(sites.edge_count() + neighbour), neighbour, neighbour});
      }
    }
    out.first.push_back(static_cast<std::uint32_t>(out.entries.size()));
  }
  throw_if_cancelled(context);
}

void build_link_segments(const MeshView& mesh, const SiteTable& sites, std::span<const Vec3d> positions,
                         const Context& context, SecondLinks& out) {
  const std::size_t edges = sites.edge_count();
  const std::size_t count = edges + mesh.vertices.size();
  if (out.segments.size() != count) out.segments = Buffer<LinkSegment>(count);
  parallel_for(context, count, grain, "", [&](const WorkRange& range) {
    for (std::size_t k = range.begin; k < range.end; ++k) {
      LinkSegment& segment = out.segments[k];
      segment = {};
      if (k >= edges) {
        const auto vertex = static_cast<std::uint32_t>(k - edges);
        segment.middle = to_float(positions[vertex]);
        segment.id = segment.start = segment.end = vertex;
        continue;
      }
      const Segment& ends = sites.edges()[k];
      const Vec3d along = positions[ends[1]] - positions[ends[0]];
      const double size = length(along);
      segment.middle = to_float((positions[ends[0]] + positions[ends[1]]) * 0.5);
      segment.id = static_cast<std::uint32_t>(mesh.vertices.size() + k);
      segment.start = ends[0];
      segment.end = ends[1];
      if (!(size > negligible_length)) continue;
      segment.tangent = to_float(along * (1 / size));
      segment.half_length = static_cast<float>(0.5 * size);
    }
  });
}

}  // namespace blum::cpu
