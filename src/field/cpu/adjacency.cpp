#include "field/cpu/adjacency.hpp"

#include <algorithm>

#include "blum/core/parallel.hpp"
#include "blum/core/radix_sort.hpp"
#include "field/kernels/morton.hpp"

namespace blum::cpu {
namespace {

constexpr std::size_t grain = 1 << 14;

/// Sorts the indices 0 .. keys.size()-1 by ascending key (all keys < key_count). The sort is stable: equal keys keep
/// the order of their indices.
void counting_order(std::span<const std::uint32_t> keys, std::size_t key_count, std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> start(key_count + 1, 0);
  for (const std::uint32_t key : keys) ++start[key + 1];
  for (std::size_t k = 0; k < key_count; ++k) start[k + 1] += start[k];
  order.resize(keys.size());
  for (std::uint32_t i = 0; i < keys.size(); ++i) order[start[keys[i]]++] = i;
}

}  // namespace

void build_adjacency(const MeshView& mesh, const SiteTable& sites, const Context& context, Adjacency& out) {
  const std::size_t vertex_count = mesh.vertices.size();
  const auto edges = sites.edges();
  std::vector<std::uint8_t> is_named(vertex_count, 0);
  for_each_named_vertex(mesh, [&](std::uint32_t v) { is_named[v] = 1; });
  out.named_vertices.clear();
  for (std::uint32_t v = 0; v < vertex_count; ++v) {
    if (is_named[v] != 0) out.named_vertices.push_back(v);
  }
  throw_if_cancelled(context);

  out.first_neighbour.assign(vertex_count + 1, 0);
  for (const Segment& edge : edges) {
    ++out.first_neighbour[edge[0] + 1];
    ++out.first_neighbour[edge[1] + 1];
  }
  for (std::size_t v = 0; v < vertex_count; ++v) out.first_neighbour[v + 1] += out.first_neighbour[v];
  out.neighbours.resize(2 * edges.size());
  std::vector<std::uint32_t> next(out.first_neighbour.begin(), out.first_neighbour.end() - 1);
  for (const Segment& edge : edges) {
    out.neighbours[next[edge[0]]++] = edge[1];
    out.neighbours[next[edge[1]]++] = edge[0];
  }
  throw_if_cancelled(context);

  out.edge_faces.assign(edges.size(), {no_index, no_index});
  const auto triangle_edges = sites.triangle_edges();
  for (std::uint32_t t = 0; t < triangle_edges.size(); ++t) {
    for (const EdgeId e : triangle_edges[t]) {
      if (!e.has_value()) continue;
      auto& faces = out.edge_faces[e.value];
      if (faces[0] == no_index) {
        faces[0] = t;
      } else if (faces[1] == no_index) {
        faces[1] = t;
      }
    }
  }
  throw_if_cancelled(context);
}

void order_sites(const MeshView& mesh, const SiteTable& sites, const Adjacency& adjacency,
                 std::span<const Vec3d> positions, const Context& context, SiteOrder& out) {
  const std::size_t named_count = adjacency.named_vertices.size();
  std::vector<detail::KeyedIndex> keyed(named_count);
  parallel_for(context, named_count, grain, "", [&](const WorkRange& range) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const std::uint32_t v = adjacency.named_vertices[i];
      keyed[i] = {kernels::morton_code(positions[v]), v};
    }
  });
  detail::radix_sort(keyed);
  std::vector<std::uint32_t>& rank = out.rank;
  rank.assign(mesh.vertices.size(), 0);
  out.vertices.resize(named_count);
  for (std::uint32_t i = 0; i < named_count; ++i) {
    out.vertices[i] = keyed[i].index;
    rank[keyed[i].index] = i;
  }
  throw_if_cancelled(context);

  std::vector<std::uint32_t> keys(sites.edge_count());
  parallel_for(context, keys.size(), grain, "", [&](const WorkRange& range) {
    for (std::size_t e = range.begin; e < range.end; ++e) {
      keys[e] = std::min(rank[sites.edges()[e][0]], rank[sites.edges()[e][1]]);
    }
  });
  counting_order(keys, named_count, out.edges);
  throw_if_cancelled(context);

  keys.resize(mesh.triangles.size());
  parallel_for(context, keys.size(), grain, "", [&](const WorkRange& range) {
    for (std::size_t t = range.begin; t < range.end; ++t) {
      const Triangle& triangle = mesh.triangles[t];
      keys[t] = std::min({rank[triangle[0]], rank[triangle[1]], rank[triangle[2]]});
    }
  });
  counting_order(keys, named_count, out.faces);
  throw_if_cancelled(context);
}

}  // namespace blum::cpu
