#include "field/second_labels.hpp"

#include <algorithm>

#include "blum/core/union_find.hpp"

namespace blum {
namespace {

/// Returns, for each vertex, the smallest vertex of its connected part (connected through edges).
std::vector<std::uint32_t> connected_parts(const MeshView& mesh, const SiteTable& sites) {
  detail::UnionFind parts(mesh.vertices.size());
  for (const Segment& edge : sites.edges()) parts.join(edge[0], edge[1]);
  std::vector<std::uint32_t> out(mesh.vertices.size());
  for (std::uint32_t v = 0; v < out.size(); ++v) out[v] = parts.find(v);
  return out;
}

/// Returns the objects renumbered: from 0, without gaps.
std::vector<std::uint32_t> numbered(std::span<const std::uint32_t> objects) {
  std::vector<std::uint32_t> names(objects.begin(), objects.end());
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  std::vector<std::uint32_t> out(objects.size());
  for (std::size_t v = 0; v < out.size(); ++v) {
    out[v] = static_cast<std::uint32_t>(std::lower_bound(names.begin(), names.end(), objects[v]) - names.begin());
  }
  return out;
}

std::size_t count_labels(const MeshView& mesh, const std::vector<std::uint32_t>& of_vertex) {
  std::vector<std::uint32_t> used;
  std::vector<bool> is_named(mesh.vertices.size(), false);
  for_each_named_vertex(mesh, [&](std::uint32_t v) { is_named[v] = true; });
  for (std::uint32_t v = 0; v < is_named.size(); ++v) {
    if (is_named[v]) used.push_back(of_vertex.empty() ? v : of_vertex[v]);
  }
  std::sort(used.begin(), used.end());
  return static_cast<std::size_t>(std::unique(used.begin(), used.end()) - used.begin());
}

}  // namespace

SecondLabels::SecondLabels(SecondRule rule, const MeshView& mesh, const SiteTable& sites,
                           std::span<const std::uint32_t> objects, const Context& context) {
  throw_if_cancelled(context);
  if (rule == SecondRule::other_object) {
    of_vertex_ = objects.empty() ? connected_parts(mesh, sites) : numbered(objects);
  }
  count_ = count_labels(mesh, of_vertex_);
}

SecondLabels::OfSite SecondLabels::of_site(const SiteTable& sites, SiteId site) const {
  const std::array<std::int32_t, 3> vertices = sites.vertices(site);
  OfSite out{};
  for (std::size_t k = 0; k < 3; ++k) {
    out[k] = vertices[k] < 0 ? out[0] : of_vertex(static_cast<std::uint32_t>(vertices[k]));
  }
  return out;
}

bool SecondLabels::has_second(const OfSite& labels) const {
  // `own` is the number of different labels given. If the mesh has more labels, a vertex with another label exists, and
  // this vertex may be second.
  const std::size_t own =
      1 + (labels[1] != labels[0] ? 1U : 0U) + (labels[2] != labels[0] && labels[2] != labels[1] ? 1U : 0U);
  return count_ > own;
}

}  // namespace blum
