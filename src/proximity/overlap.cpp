#include "proximity/overlap.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <utility>

#include "blum/core/error.hpp"
#include "blum/core/union_find.hpp"
#include "blum/geometry/resolve_crossings.hpp"

namespace blum::detail {
namespace {

/// Joins edges with common ends to chains.
class Chains {
 public:
  explicit Chains(const std::vector<Edge>& edges) {
    for (const auto& [a, b] : edges) {
      at_[a].push_back(b);
      at_[b].push_back(a);
    }
  }
  /// Returns all chains, as lists of vertices.
  std::vector<std::vector<std::uint32_t>> all() {
    std::vector<std::vector<std::uint32_t>> out;
    // Chains with two ends come first, then closed chains.
    for (const bool is_closed : {false, true}) {
      for (const auto& [v, others] : at_) {
        if (!is_closed && others.size() == 2) continue;
        for (const std::uint32_t next : others) {
          if (!used_.contains(std::minmax(v, next))) out.push_back(chain(v, next));
        }
      }
    }
    return out;
  }

 private:
  std::vector<std::uint32_t> chain(std::uint32_t from, std::uint32_t next) {
    std::vector<std::uint32_t> out{from};
    std::uint32_t last = from;
    while (true) {
      used_[std::minmax(last, next)] = true;
      out.push_back(next);
      const std::vector<std::uint32_t>& others = at_[next];
      if (others.size() != 2 || next == from) return out;
      const std::uint32_t after = others[0] == last ? others[1] : others[0];
      last = next;
      next = after;
      if (used_.contains(std::minmax(last, next))) return out;
    }
  }

  std::map<std::uint32_t, std::vector<std::uint32_t>> at_;
  std::map<Edge, bool> used_;
};

}  // namespace

std::map<Edge, std::vector<std::uint32_t>> triangles_at_edges(const MeshView& mesh,
                                                              std::span<const std::uint32_t> triangles) {
  std::map<Edge, std::vector<std::uint32_t>> out;
  for (const std::uint32_t t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
      out[{low, high}].push_back(t);
    }
  }
  return out;
}

Overlap overlap_of(const MeshView& surfaces, const Context& context) {
  ResolveOptions options;
  options.least_winding = 2;
  options.most_rounds = 0;  // distances are rounded anyway
  options.most_pairs = std::size_t{1} << 22;
  ResolvedMesh resolved = resolve_crossings(surfaces, options, context);
  if (!resolved.has_inside) return {};
  if (!resolved.is_resolved()) return {{}, {}, {}, resolved.obstacle};
  return {std::move(resolved.mesh), std::move(resolved.triangle_of), std::move(resolved.body_of), {}};
}

std::vector<std::uint32_t> patches_of(const Overlap& overlap,
                                      FunctionRef<bool(std::uint32_t, std::uint32_t)> are_neighbours) {
  const std::size_t count = overlap.mesh.triangles.size();
  std::vector<std::uint32_t> all(count);
  UnionFind joined(count);
  for (std::uint32_t t = 0; t < count; ++t) all[t] = t;
  for (const auto& [edge, triangles] : triangles_at_edges(overlap.mesh, all)) {
    for (std::size_t k = 1; k < triangles.size(); ++k) {
      const std::uint32_t a = overlap.source[triangles[0]];
      const std::uint32_t b = overlap.source[triangles[k]];
      if (a == b || are_neighbours(a, b)) joined.join(triangles[0], triangles[k]);
    }
  }
  for (std::uint32_t& t : all) t = joined.find(t);
  return all;
}

std::vector<std::vector<Vec3d>> border_curves(const TriangleMesh& mesh, const std::vector<std::uint32_t>& labels,
                                              const std::vector<std::uint32_t>& triangles) {
  std::vector<Edge> edges;
  for (const auto& [edge, sides] : triangles_at_edges(mesh, triangles)) {
    const auto differs = [&](std::uint32_t t) { return labels[t] != labels[sides[0]]; };
    if (std::any_of(sides.begin(), sides.end(), differs)) edges.push_back(edge);
  }
  std::vector<std::vector<Vec3d>> out;
  for (const std::vector<std::uint32_t>& chain : Chains(edges).all()) {
    std::vector<Vec3d>& curve = out.emplace_back();
    for (const std::uint32_t v : chain) curve.push_back(mesh.vertices[v]);
  }
  return out;
}

}  // namespace blum::detail
