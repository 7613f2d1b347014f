#include "blum/geometry/surface_patches.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

#include "blum/core/sort_unique.hpp"
#include "blum/core/union_find.hpp"

namespace blum::detail {
namespace {

/// Allowance for rounding. So the sides of a twelve-sided prism, whose edges bend by 30 degrees, form one patch at the
/// angle 30.
constexpr double rounding = 1e-6;  // degrees

/// Returns true if a triangle runs along an edge from its smaller to its larger vertex.
bool runs_along(const Triangle& triangle, const Segment& edge) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (triangle[k] == edge[0] && triangle[(k + 1) % 3] == edge[1]) return true;
  }
  return false;
}

}  // namespace

std::vector<Vec3d> triangle_normals(const MeshView& mesh) {
  std::vector<Vec3d> out;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3d& at = mesh.vertices[a];
    out.push_back(cross(mesh.vertices[b] - at, mesh.vertices[c] - at));
  }
  return out;
}

std::vector<std::uint8_t> smooth_edges(const MeshView& mesh, const SiteTable& sites, std::span<const Vec3d> normals,
                                       double angle) {
  const double least_cosine = std::cos(std::min(180.0, angle + rounding) * std::numbers::pi / 180);
  struct Sides {
    std::uint32_t first = 0, second = 0, count = 0;
  };
  std::vector<Sides> sides(sites.edge_count());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const EdgeId edge : sites.triangle_edges()[t]) {
      if (edge == EdgeId::none()) continue;
      Sides& own = sides[edge.value];
      (own.count == 0 ? own.first : own.second) = t;
      ++own.count;
    }
  }
  std::vector<std::uint8_t> out(sides.size(), 0);
  for (std::size_t e = 0; e < sides.size(); ++e) {
    const auto& [a, b, count] = sides[e];
    const double scale = length(normals[a]) * length(normals[b]);
    if (count != 2 || !(scale > 0)) continue;
    const Segment& ends = sites.edges()[e];
    const bool agree = runs_along(mesh.triangles[a], ends) != runs_along(mesh.triangles[b], ends);
    out[e] = (agree ? 1 : -1) * dot(normals[a], normals[b]) >= least_cosine * scale ? 1 : 0;
  }
  return out;
}

SurfacePatches::SurfacePatches(const MeshView& mesh, double angle, const Context& context)
    : SurfacePatches((validate(mesh), mesh), SiteTable(mesh, context), angle, context) {}

SurfacePatches::SurfacePatches(const MeshView& mesh, SiteTable sites, double angle, const Context& context)
    : SurfacePatches(mesh, std::move(sites), triangle_normals(mesh), angle, context) {}

SurfacePatches::SurfacePatches(const MeshView& mesh, SiteTable sites, std::vector<Vec3d> normals, double angle,
                               const Context& context)
    : mesh_(mesh), sites_(std::move(sites)), normals_(std::move(normals)) {
  find_rows();
  join_faces(angle, context);
  add_up();
}

SurfacePatches::SurfacePatches(const MeshView& mesh, SiteTable sites, std::vector<Vec3d> normals,
                               std::vector<std::uint32_t> patch_of)
    : mesh_(mesh), sites_(std::move(sites)), normals_(std::move(normals)), patch_of_(std::move(patch_of)) {
  find_rows();
  for (const std::uint32_t patch : patch_of_) {
    if (patch != none && patch >= patches_.size()) patches_.resize(patch + std::size_t{1});
  }
  add_up();
}

void SurfacePatches::find_rows() {
  const auto fill = [&](Rows& rows, std::size_t count, const auto& places_of) {
    rows.first.assign(count + 1, 0);
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      places_of(t, [&](std::size_t place) { ++rows.first[place + 1]; });
    }
    std::partial_sum(rows.first.begin(), rows.first.end(), rows.first.begin());
    rows.triangles.resize(rows.first.back());
    std::vector<std::size_t> next(rows.first.begin(), rows.first.end() - 1);
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      places_of(t, [&](std::size_t place) { rows.triangles[next[place]++] = t; });
    }
  };
  fill(at_edges_, sites_.edge_count(), [&](std::uint32_t t, const auto& take) {
    for (const EdgeId edge : sites_.triangle_edges()[t]) {
      if (edge != EdgeId::none()) take(edge.value);
    }
  });
  fill(at_vertices_, sites_.vertex_count(), [&](std::uint32_t t, const auto& take) {
    for (const std::uint32_t v : mesh_.triangles[t]) take(v);
  });
}

void SurfacePatches::join_faces(double angle, const Context& context) {
  throw_if_cancelled(context);
  const std::vector<std::uint8_t> is_smooth = smooth_edges(mesh_, sites_, normals_, angle);
  throw_if_cancelled(context);
  detail::UnionFind faces(mesh_.triangles.size());
  for (std::uint32_t e = 0; e < sites_.edge_count(); ++e) {
    const std::size_t begin = at_edges_.first[e];
    if (is_smooth[e] != 0) faces.join(at_edges_.triangles[begin], at_edges_.triangles[begin + 1]);
  }
  patch_of_.assign(mesh_.triangles.size(), none);
  for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
    if (!(squared_length(normals_[t]) > 0)) continue;
    const std::uint32_t first = faces.find(t);
    if (patch_of_[first] == none) {
      patch_of_[first] = static_cast<std::uint32_t>(patches_.size());
      patches_.emplace_back();
    }
    patch_of_[t] = patch_of_[first];
  }
}

void SurfacePatches::add_up() {
  for (std::size_t t = 0; t < patch_of_.size(); ++t) {
    if (patch_of_[t] == none) continue;
    SurfacePatch& patch = patches_[patch_of_[t]];
    const auto& [a, b, c] = mesh_.triangles[t];
    const double area = 0.5 * length(normals_[t]);
    ++patch.faces;
    patch.area += area;
    patch.centroid += area / 3 * (mesh_.vertices[a] + mesh_.vertices[b] + mesh_.vertices[c]);
    patch.normal += 0.5 * normals_[t];
  }
  for (SurfacePatch& patch : patches_) {
    patch.centroid = patch.centroid / patch.area;
    const double size = length(patch.normal);
    // For a closed surface the sum is 0 up to rounding.
    patch.normal = size > 1e-9 * patch.area ? patch.normal / size : Vec3d{};
  }
}

std::vector<std::uint32_t> SurfacePatches::at(SiteId site) const {
  const Site on = sites_.site(site);
  std::vector<std::uint32_t> out;
  if (on.kind == SiteKind::face) {
    if (patch_of_[on.index] != none) out.push_back(patch_of_[on.index]);
    return out;
  }
  const Rows& rows = on.kind == SiteKind::edge ? at_edges_ : at_vertices_;
  for (std::size_t k = rows.first[on.index]; k < rows.first[std::size_t{on.index} + 1]; ++k) {
    if (patch_of_[rows.triangles[k]] != none) out.push_back(patch_of_[rows.triangles[k]]);
  }
  detail::sort_unique(out);
  return out;
}

}  // namespace blum::detail
