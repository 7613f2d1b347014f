#include "proximity/moving_features.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "blum/core/sort_unique.hpp"
#include "blum/geometry/weld.hpp"

namespace blum {
namespace {

/// For each vertex that the mesh names the smallest one of these that is in the same place at both ends; empty where
/// all are by themselves.
std::vector<std::uint32_t> places(const MeshView& mesh, std::span<const Vec3d> end) {
  const std::vector<std::uint32_t> first = weld_clusters(mesh.vertices);
  std::vector<bool> is_shared(first.size(), false);  // of the first vertex in a place at the start
  for (std::uint32_t v = 0; v < first.size(); ++v) {
    if (first[v] != v) is_shared[first[v]] = true;
  }
  std::vector<std::uint32_t> together;
  for_each_named_vertex(mesh, [&](std::uint32_t v) {
    if (is_shared[first[v]]) together.push_back(v);
  });
  if (together.empty()) return {};
  detail::sort_unique(together);
  const std::vector<std::uint32_t> last = weld_clusters(end);
  const auto key = [&](std::uint32_t v) { return std::pair(first[v], last[v]); };
  std::sort(together.begin(), together.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  std::vector<std::uint32_t> out(first.size());
  for (std::uint32_t v = 0; v < out.size(); ++v) out[v] = v;
  for (std::size_t k = 1; k < together.size(); ++k) {
    if (key(together[k]) == key(together[k - 1])) out[together[k]] = out[together[k - 1]];
  }
  return out;
}

}  // namespace

MovingFeatures::MovingFeatures(const MeshView& mesh, std::span<const Vec3d> end, const Context& context)
    : mesh_(mesh), end_(end), place_(places(mesh, end)) {
  throw_if_cancelled(context);
  for_each_named_vertex(mesh, [&](std::uint32_t v) { vertices_.push_back(place(v)); });
  detail::sort_unique(vertices_);
  const auto add_edge = [&](std::uint32_t a, std::uint32_t b) {
    const std::uint32_t from = place(a);
    const std::uint32_t to = place(b);
    if (from != to) edges_.push_back({std::min(from, to), std::max(from, to)});
  };
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) add_edge(t[k], t[(k + 1) % 3]);
  }
  for (const Segment& s : mesh.segments) add_edge(s[0], s[1]);
  detail::sort_unique(edges_);
}

}  // namespace blum
