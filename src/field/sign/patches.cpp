#include "field/sign/patches.hpp"

#include <algorithm>
#include <cstddef>

#include "blum/core/union_find.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/weld.hpp"
#include "field/sign/policy.hpp"

namespace blum::sign {
namespace {

/// How often an edge is run along, and by which triangle last.
struct EdgeUse {
  std::uint32_t count = 0;
  std::int32_t balance = 0;
  std::uint32_t triangle = 0;
};

/// Triangles that nothing touches and that have a normal; empty where too many touch.
std::vector<bool> find_free_triangles(const MeshView& mesh, const Context& context) {
  const std::size_t most = 1000 + mesh.triangles.size() / 4;
  const Context quiet{.threads = context.threads, .cancel = context.cancel};
  const SelfIntersections found = find_self_intersections(mesh, most, quiet);
  if (!found.complete) return {};
  std::vector<bool> is_free(mesh.triangles.size(), true);
  for (const TrianglePair& pair : found.pairs) is_free[pair.first.value] = is_free[pair.second.value] = false;
  for (std::size_t t = 0; t < is_free.size(); ++t) {
    if (is_too_flat(mesh, mesh.triangles[t])) is_free[t] = false;
  }
  return is_free;
}

/// Vertices at whose place there is another one that something names.
std::vector<bool> find_shared_places(const MeshView& mesh) {
  const std::vector<std::uint32_t> place = weld_clusters(mesh.vertices);
  std::vector<bool> is_named(mesh.vertices.size(), false);
  for_each_named_vertex(mesh, [&](std::uint32_t v) { is_named[v] = true; });
  std::vector<std::uint32_t> named_at(mesh.vertices.size(), 0);
  for (std::size_t v = 0; v < place.size(); ++v) named_at[place[v]] += is_named[v] ? 1 : 0;
  std::vector<bool> is_shared(mesh.vertices.size());
  for (std::size_t v = 0; v < place.size(); ++v) is_shared[v] = named_at[place[v]] > 1;
  return is_shared;
}

/// The common patch of what is added.
void add(std::uint32_t patch, bool is_first, std::uint32_t& common) {
  if (is_first) common = patch;
  if (common != patch) common = no_patch;
}

class Finder {
 public:
  Finder(const MeshView& mesh, const SiteTable& sites, std::vector<bool> is_free)
      : mesh_(mesh), sites_(sites), is_free_(std::move(is_free)), uses_(sites.edge_count()) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const EdgeId edge = sites.triangle_edges()[t][k];
        if (!edge.has_value()) continue;
        EdgeUse& use = uses_[edge.value];
        ++use.count;
        use.balance += mesh.triangles[t][k] < mesh.triangles[t][(k + 1) % 3] ? 1 : -1;
        use.triangle = t;
      }
    }
  }

  Patches find() {
    Patches out;
    const std::vector<bool> is_shared = find_shared_places(mesh_);
    for (std::size_t e = 0; e < uses_.size(); ++e) {
      const Segment& ends = sites_.edges()[e];
      if (is_shared[ends[0]] && is_shared[ends[1]]) uses_[e].count = 0;
    }
    const std::vector<std::uint32_t> of_triangle = join_triangles(out);
    set_sites(of_triangle, is_shared, out);
    return out;
  }

 private:
  [[nodiscard]] bool joins(const EdgeUse& use) const { return use.count == 2 && use.balance == 0; }

  std::vector<std::uint32_t> join_triangles(Patches& out) const {
    const auto count = static_cast<std::uint32_t>(mesh_.triangles.size());
    detail::UnionFind sets(count);
    for (std::uint32_t t = 0; t < count; ++t) {
      if (!is_free_[t]) continue;
      for (const EdgeId edge : sites_.triangle_edges()[t]) {
        const EdgeUse& use = uses_[edge.value];
        if (joins(use) && is_free_[use.triangle]) sets.join(t, use.triangle);
      }
    }
    std::vector<std::uint32_t> of_triangle(count, no_patch);
    std::vector<double> area;
    for (std::uint32_t t = 0; t < count; ++t) {
      if (!is_free_[t]) continue;
      const std::uint32_t root = sets.find(t);
      if (root == t) {
        of_triangle[t] = out.count++;
        out.largest.push_back(t);
        area.push_back(0);
      }
      const std::uint32_t patch = of_triangle[t] = of_triangle[root];
      const Triangle& c = mesh_.triangles[t];
      const Vec3d u = mesh_.vertices[c[1]] - mesh_.vertices[c[0]];
      const double own = squared_length(cross(u, mesh_.vertices[c[2]] - mesh_.vertices[c[0]]));
      if (own > area[patch]) {
        area[patch] = own;
        out.largest[patch] = t;
      }
    }
    return of_triangle;
  }

  void set_sites(const std::vector<std::uint32_t>& of_triangle, const std::vector<bool>& is_shared,
                 Patches& out) const {
    out.of_site.assign(sites_.size(), no_patch);
    const std::size_t edges = sites_.vertex_count();
    const std::size_t faces = edges + sites_.edge_count();
    std::vector<bool> is_seen(faces, false);
    for (std::uint32_t t = 0; t < of_triangle.size(); ++t) {
      const std::uint32_t patch = of_triangle[t];
      out.of_site[faces + t] = patch;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t v = mesh_.triangles[t][k];
        add(is_shared[v] ? no_patch : patch, !is_seen[v], out.of_site[v]);
        is_seen[v] = true;
        const EdgeId edge = sites_.triangle_edges()[t][k];
        if (!edge.has_value()) continue;
        const std::size_t e = edges + edge.value;
        add(joins(uses_[edge.value]) ? patch : no_patch, !is_seen[e], out.of_site[e]);
        is_seen[e] = true;
      }
    }
    // Free segments are no boundary, but what is closest to one is not closest to a triangle.
    for (const Segment& s : mesh_.segments) out.of_site[s[0]] = out.of_site[s[1]] = no_patch;
    for (const std::uint32_t v : mesh_.points) out.of_site[v] = no_patch;
  }

  const MeshView& mesh_;
  const SiteTable& sites_;
  std::vector<bool> is_free_;
  std::vector<EdgeUse> uses_;
};

}  // namespace

Patches find_patches(const MeshView& mesh, const SiteTable& sites, const Context& context) {
  std::vector<bool> is_free = find_free_triangles(mesh, context);
  if (is_free.empty()) return {0, std::vector<std::uint32_t>(sites.size(), no_patch), {}};
  return Finder(mesh, sites, std::move(is_free)).find();
}

}  // namespace blum::sign
