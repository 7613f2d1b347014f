#include "field/sign/sides.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/parallel.hpp"
#include "blum/core/union_find.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/geometry/weld.hpp"
#include "field/sign/policy.hpp"

namespace blum::sign {
namespace {

inline constexpr std::uint32_t no_patch = 0xffffffff;

/// Patches: sets of triangles that are connected across edges. Exactly two triangles share such an edge, and traverse
/// it in opposite directions. No triangle of a patch is too flat for a normal. None touches or crosses a triangle that
/// is not its neighbour.
struct Patches {
  std::uint32_t count = 0;
  /// Per site: the patch that contains all triangles at the site; no_patch if these triangles are not all in one patch.
  /// It is also no_patch if another vertex or edge coincides with the site.
  std::vector<std::uint32_t> of_site;
  /// Largest triangle of each patch.
  std::vector<std::uint32_t> largest;
};

/// Uses of one edge by triangles: their number, the balance of their directions, and the last triangle.
struct EdgeUse {
  std::uint32_t count = 0;
  std::int32_t balance = 0;
  std::uint32_t triangle = 0;
};

/// Finds triangles that have a normal and that no other triangle touches, except neighbours. The result is empty if too
/// many triangles touch.
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

/// Finds vertices that lie at the same position as another vertex in use.
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

/// Combines a patch with the patch of a site so far. If the two patches differ, the result is no_patch.
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
    // Free segments and points do not change winding numbers. But if a query is closest to one of them, no triangle
    // decides its side.
    for (const Segment& s : mesh_.segments) out.of_site[s[0]] = out.of_site[s[1]] = no_patch;
    for (const std::uint32_t v : mesh_.points) out.of_site[v] = no_patch;
  }

  const MeshView& mesh_;
  const SiteTable& sites_;
  std::vector<bool> is_free_;
  std::vector<EdgeUse> uses_;
};

/// Finds the patches of a mesh.
/// @throws Cancelled.
/// Cost: that of find_self_intersections(). There are no patches if more pairs of triangles touch than 1,000 plus a
/// quarter of the number of triangles.
Patches find_patches(const MeshView& mesh, const SiteTable& sites, const Context& context) {
  std::vector<bool> is_free = find_free_triangles(mesh, context);
  if (is_free.empty()) return {0, std::vector<std::uint32_t>(sites.size(), no_patch), {}};
  return Finder(mesh, sites, std::move(is_free)).find();
}

constexpr std::size_t patches_per_range = 16;

/// Returns the winding number in front of a triangle's middle. Returns nothing if it is uncertain.
std::optional<int> winding_in_front(const MeshView& mesh, const SiteTable& sites, const Bvh& bvh,
                                    const WindingNumber& winding, std::uint32_t triangle) {
  const SiteId face = sites.id({SiteKind::face, triangle});
  const Triangle& t = mesh.triangles[triangle];
  const Vec3d a = mesh.vertices[t[0]];
  const Vec3d u = mesh.vertices[t[1]] - a;
  const Vec3d v = mesh.vertices[t[2]] - a;
  const Vec3d normal = cross(u, v);
  const double size = length(normal);
  if (!(size > 0)) return std::nullopt;
  const Vec3d middle = a + (u + v) * (1.0 / 3);
  // The query point is moved off the triangle by a step. The step is reduced until no other site is equally close.
  double step = 0.1 * std::sqrt(size);
  for (int k = 0; k < 24; ++k, step *= 0.25) {
    const Vec3d place = middle + normal * (step / size);
    const std::optional<NearestSite> nearest = bvh.nearest(place);
    if (!nearest || nearest->site != face || !(nearest->distance > 0.5 * step)) continue;
    const double found = winding.estimate(place, 1e-3).value;
    const double whole = std::round(found);
    if (std::abs(found - whole) < 0.05 && std::abs(whole) < 1e9) return static_cast<int>(whole);
  }
  return std::nullopt;
}

}  // namespace

Sides::Sides(const Plan& plan, const MeshView& mesh, const SiteTable& sites, const Bvh& bvh, const Context& context)
    : method_(plan.method), level_(plan.level), bounds_(bvh.bounds()) {
  if (method_ == Method::none) return;
  if (method_ != Method::sums) normals_.emplace(mesh, sites, context);
  if (method_ == Method::pseudonormals || plan.is_simple) return;
  winding_.emplace(mesh, sites, context);
  if (method_ == Method::crossings) find_patches(mesh, sites, bvh, context);
}

void Sides::find_patches(const MeshView& mesh, const SiteTable& sites, const Bvh& bvh, const Context& context) {
  Patches patches = sign::find_patches(mesh, sites, context);
  in_front_.resize(patches.count);
  std::vector<std::uint8_t> is_known(patches.count, 0);
  parallel_for(context, patches.count, patches_per_range, "", [&](const WorkRange& range) {
    for (std::size_t p = range.begin; p < range.end; ++p) {
      const std::optional<int> found = winding_in_front(mesh, sites, bvh, *winding_, patches.largest[p]);
      is_known[p] = found ? 1 : 0;
      in_front_[p] = found.value_or(0);
    }
  });
  for (std::uint32_t& patch : patches.of_site) {
    if (patch != no_patch && is_known[patch] == 0) patch = no_patch;
  }
  patch_ = std::move(patches.of_site);
}

std::size_t Sides::open_site_count() const {
  return static_cast<std::size_t>(std::count(patch_.begin(), patch_.end(), no_patch));
}

bool Sides::is_inside(const Vec3d& query, const NearestSite& nearest) const {
  const std::optional<bool> known = is_inside_by_site(query, nearest);
  return known ? *known : winding_->decide(query, nearest.distance).is_inside;
}

std::optional<bool> Sides::is_inside_by_patch(const Vec3d& query, SiteId site, bool is_behind) const {
  const std::uint32_t patch = patch_[site.value];
  if (patch != no_patch) return in_front_[patch] + (is_behind ? 1 : 0) > level_;
  if (level_ == 0) return std::nullopt;
  return winding_->estimate(query, 0.25).value > level_ + 0.5;
}

}  // namespace blum::sign
