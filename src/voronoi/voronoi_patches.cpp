#include "blum/voronoi/voronoi_patches.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/check_angle.hpp"
#include "blum/core/sort_unique.hpp"
#include "blum/core/union_find.hpp"
#include "blum/geometry/fitted_patches.hpp"
#include "blum/geometry/surface_patches.hpp"
#include "voronoi/site_patches.hpp"

namespace blum {
namespace {

using detail::SurfacePatches;

constexpr std::uint32_t none = UINT32_MAX;

[[noreturn]] void refuse_sites(const std::string& found) {
  throw InvalidOption("voronoi_patches(): " + found + ": pass the sites of this mesh, from voronoi_sites()");
}

/// @throws InvalidOption unless each triangle belongs to one face, and all edges and vertices exist.
void check_sites(const MeshView& mesh, const SiteTable& table, std::span<const VoronoiSite> sites) {
  std::vector<std::uint8_t> is_used(mesh.triangles.size(), 0);
  for (const VoronoiSite& site : sites) {
    for (const std::uint32_t t : site.triangles) {
      if (t >= is_used.size()) refuse_sites("a face has triangle " + std::to_string(t) + ", but the mesh does not");
      if (is_used[t] != 0) refuse_sites("triangle " + std::to_string(t) + " belongs to two faces");
      is_used[t] = 1;
    }
    for (const std::uint32_t v : site.vertices) {
      if (v >= table.vertex_count()) refuse_sites("a site has vertex " + std::to_string(v) + ", but the mesh does not");
    }
    const std::size_t corners = site.kind == SiteKind::face ? 0 : site.kind == SiteKind::edge ? 2 : 1;
    if (site.vertices.size() != corners) refuse_sites("a site has the wrong number of vertices");
  }
  const auto unused = std::find(is_used.begin(), is_used.end(), 0);
  if (unused == is_used.end()) return;
  refuse_sites("triangle " + std::to_string(unused - is_used.begin()) + " belongs to no face");
}

/// Returns for each triangle the direction of its face's mean normal. So a needle whose own normal is only rounding has
/// the normal of its face. If all triangles of a face are so thin that their normals round to 0, they have none.
std::vector<Vec3d> normals_of_faces(const MeshView& mesh, std::span<const VoronoiSite> sites) {
  std::vector<Vec3d> out(mesh.triangles.size());
  const double scale = 1 / bounds(mesh).diagonal();  // products of tiny coordinates would round to 0
  for (const VoronoiSite& site : sites) {
    Vec3d sum;
    for (const std::uint32_t t : site.triangles) {
      const auto [a, b, c] = triangle_corners(mesh, t);
      sum += cross((b - a) * scale, (c - a) * scale);
    }
    const double size = length(sum);
    for (const std::uint32_t t : site.triangles) {
      if (size > 0) out[t] = sum / size;
    }
  }
  return out;
}

/// Returns for each triangle the number of its face.
std::vector<std::uint32_t> faces_of(const MeshView& mesh, std::span<const VoronoiSite> sites) {
  std::vector<std::uint32_t> out(mesh.triangles.size(), none);
  for (std::uint32_t s = 0; s < sites.size(); ++s) {
    for (const std::uint32_t t : sites[s].triangles) out[t] = s;
  }
  return out;
}

class PatchFinder {
 public:
  /// @param shapes  for each patch of the surface; empty if shapes were not fitted.
  PatchFinder(const SiteTable& table, std::span<const VoronoiSite> sites, const SurfacePatches& surface,
              std::vector<SurfaceShape> shapes, std::vector<std::uint8_t> smooth)
      : table_(table),
        sites_(sites),
        surface_(surface),
        shapes_(std::move(shapes)),
        smooth_(std::move(smooth)),
        joined_(surface.patches().size()),
        number_(surface.patches().size(), none) {}

  std::vector<VoronoiPatch> find() {
    join_faces();
    for (std::uint32_t s = 0; s < sites_.size(); ++s) {
      if (sites_[s].kind == SiteKind::face) {
        add_face(s);
        continue;
      }
      std::vector<std::uint32_t> around = patches_at(sites_[s]);
      if (around.size() == 1) {
        add_to(around.front(), s);
      } else if (around.size() == 2 && is_smooth(sites_[s], around)) {
        add_to(more_curved(around), s);
      } else {
        between_.emplace_back(s, std::move(around));
      }
    }
    add_chains();
    return std::move(out_);
  }

 private:
  void add_to(std::uint32_t patch, std::uint32_t site) { out_[patch].sites.push_back(static_cast<std::int32_t>(site)); }

  /// Adds a face to the patch of its triangles. A face without a normal is a patch of its own.
  void add_face(std::uint32_t s) {
    if (sites_[s].triangles.empty()) return;
    const std::uint32_t on_surface = surface_.of_face(sites_[s].triangles.front());
    std::uint32_t own = none;
    std::uint32_t& patch = on_surface == SurfacePatches::none ? own : number_[joined_.find(on_surface)];
    if (patch == none) {
      patch = static_cast<std::uint32_t>(out_.size());
      out_.push_back({SiteKind::face, {}, {}});
      if (on_surface < shapes_.size()) out_.back().shape = shapes_[on_surface];
    }
    add_to(patch, s);
  }

  /// Joins patches of the surface that one face connects.
  void join_faces() {
    for (const VoronoiSite& site : sites_) {
      for (const std::uint32_t t : site.triangles) {
        const std::uint32_t first = surface_.of_face(site.triangles.front());
        if (first != SurfacePatches::none) joined_.join(surface_.of_face(t), first);
      }
    }
  }

  /// Returns the number of an edge in the mesh.
  [[nodiscard]] std::uint32_t edge_of(const VoronoiSite& site) const {
    const Segment ends{site.vertices[0], site.vertices[1]};
    const auto at = std::lower_bound(table_.edges().begin(), table_.edges().end(), ends);
    if (at == table_.edges().end() || *at != ends) refuse_sites("an edge does not exist in the mesh");
    return static_cast<std::uint32_t>(at - table_.edges().begin());
  }

  /// Returns true if two fitted patches meet smoothly at an edge, or at a vertex of such an edge. Edges come first.
  [[nodiscard]] bool is_smooth(const VoronoiSite& site, const std::vector<std::uint32_t>& around) {
    if (smooth_.empty()) return false;
    const std::pair pair(around[0], around[1]);
    if (site.kind == SiteKind::vertex) return smooth_pairs_.contains(pair);
    if (smooth_[edge_of(site)] == 0) return false;
    smooth_pairs_.insert(pair);
    return true;
  }
  /// Returns the first of two patches that is not a plane; the first one if both are planes.
  [[nodiscard]] std::uint32_t more_curved(const std::vector<std::uint32_t>& around) const {
    const auto is_plane = [&](std::uint32_t patch) {
      return out_[patch].shape && out_[patch].shape->kind == SurfaceKind::plane;
    };
    return is_plane(around[0]) && !is_plane(around[1]) ? around[1] : around[0];
  }

  /// Returns the patches of the faces at an edge or a vertex, ascending.
  [[nodiscard]] std::vector<std::uint32_t> patches_at(const VoronoiSite& site) {
    Site on{SiteKind::vertex, site.vertices.front()};
    if (site.kind == SiteKind::edge) on = {SiteKind::edge, edge_of(site)};
    std::vector<std::uint32_t> out;
    for (const std::uint32_t patch : surface_.at(table_.id(on))) out.push_back(number_[joined_.find(patch)]);
    detail::sort_unique(out);
    return out;
  }

  /// Adds the patches of edges and vertices that lie between patches of faces. Two such sites belong together if they
  /// have a vertex in common, and the same patches around them.
  void add_chains() {
    detail::UnionFind joined(between_.size());
    std::map<std::pair<std::uint32_t, std::vector<std::uint32_t>>, std::uint32_t> first;  // by vertex and patches
    for (std::uint32_t k = 0; k < between_.size(); ++k) {
      const auto& [site, around] = between_[k];
      for (const std::uint32_t v : sites_[site].vertices)
        joined.join(k, first.try_emplace({v, around}, k).first->second);
    }
    // Edges have smaller numbers than vertices, so the first site of a chain decides its kind.
    std::vector<std::uint32_t> number(between_.size(), none);
    for (std::uint32_t k = 0; k < between_.size(); ++k) {
      std::uint32_t& patch = number[joined.find(k)];
      if (patch == none) {
        patch = static_cast<std::uint32_t>(out_.size());
        out_.push_back({sites_[between_[k].first].kind, {}, {}});
      }
      add_to(patch, between_[k].first);
    }
  }

  const SiteTable& table_;
  std::span<const VoronoiSite> sites_;
  const SurfacePatches& surface_;
  std::vector<SurfaceShape> shapes_;
  std::vector<std::uint8_t> smooth_;                                ///< for each edge; empty without shapes
  std::set<std::pair<std::uint32_t, std::uint32_t>> smooth_pairs_;  ///< patches with a smooth reflex edge between them
  detail::UnionFind joined_;                                        ///< patches of the surface
  std::vector<std::uint32_t> number_;  ///< for each patch of the surface that joined_ keeps
  std::vector<std::pair<std::uint32_t, std::vector<std::uint32_t>>> between_;  ///< sites, and the patches around them
  std::vector<VoronoiPatch> out_;
};

}  // namespace

std::vector<VoronoiPatch> voronoi_patches(const MeshView& mesh, std::span<const VoronoiSite> sites,
                                          const VoronoiPatchOptions& options, const Context& context) {
  detail::check_angle("patch_angle", options.patch_angle);
  detail::check_patch_fit(options.patch_fit);
  validate(mesh);
  const SiteTable table(mesh, context);
  check_sites(mesh, table, sites);
  std::vector<Vec3d> normals = normals_of_faces(mesh, sites);
  if (!options.patch_fit) {
    const SurfacePatches surface(mesh, table, std::move(normals), options.patch_angle, context);
    return PatchFinder(table, sites, surface, {}, {}).find();
  }
  const std::vector<std::uint32_t> face_of = faces_of(mesh, sites);
  detail::FittedPatches fitted =
      detail::fit_patches(mesh, table, {face_of, normals, *options.patch_fit, options.patch_angle}, context);
  std::vector<std::uint8_t> smooth = detail::smooth_edges(mesh, table, normals, options.patch_angle);
  const SurfacePatches surface(mesh, table, std::move(normals), std::move(fitted.patch_of));
  return PatchFinder(table, sites, surface, std::move(fitted.shapes), std::move(smooth)).find();
}

void add_patch_columns(Complex& complex, std::span<const VoronoiPatch> patches) {
  validate(complex);
  const auto site_a = complex.triangle_columns.get<std::int32_t>("site_a");
  const auto site_b = complex.triangle_columns.get<std::int32_t>("site_b");
  const voronoi::SitePatches patch_of(patches);
  std::array<std::vector<std::int32_t>, 2> columns;
  for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
    const auto [a, b] = std::minmax({patch_of.of_side(site_a[t]), patch_of.of_side(site_b[t])});
    columns[0].push_back(a);
    columns[1].push_back(b);
  }
  for (std::size_t side = 0; side < columns.size(); ++side) {
    const std::string_view name = medial_columns::patches[side];
    complex.triangle_columns.erase(name);
    complex.triangle_columns.add({std::string(name), 1, std::move(columns[side])});
  }
}

}  // namespace blum
