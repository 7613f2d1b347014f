#include "blum/voronoi/axis_patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/error.hpp"
#include "blum/core/parallel.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/sites.hpp"
#include "voronoi/site_patches.hpp"

namespace blum {
namespace {

constexpr std::int32_t outside = -1;
constexpr std::size_t triangles_per_range = 64;
constexpr double to_degrees = 180 / std::numbers::pi;
/// Smallest angle between two contacts, degrees. Contacts on neighbouring facets that round to one plane are closer.
constexpr double least_angle = 1;

[[noreturn]] void refuse() {
  throw InvalidOption("the sites are not those of the mesh: pass those of voronoi_sites()");
}

/// Returns for each site of the mesh the number of its patch. Edges and vertices that are not sites of the diagram
/// belong to the patch of a face, or of a reflex edge at them.
std::vector<std::int32_t> patches_of_sites(const SiteTable& table, std::span<const VoronoiSite> sites,
                                           std::span<const VoronoiPatch> patches) {
  const voronoi::SitePatches patch_of(patches);
  std::vector<std::int32_t> out(table.size(), outside);
  const auto set = [&](const Site& site, std::int32_t patch, bool replaces) {
    std::int32_t& known = out[table.id(site).value];
    if (replaces || known == outside) known = patch;
  };
  const auto check = [](std::size_t index, std::size_t count) {
    if (index >= count) refuse();
  };
  // Faces come first, then edges, then vertices. Each site overwrites the numbers that earlier sites wrote for its part
  // of the mesh.
  for (std::size_t s = 0; s < sites.size(); ++s) {
    const auto number = static_cast<std::int32_t>(s);
    for (const std::uint32_t t : sites[s].triangles) {
      check(t, table.face_count());
      const std::int32_t patch = patch_of.of_side(number);
      set({SiteKind::face, t}, patch, true);
      for (const EdgeId e : table.triangle_edges()[t]) set({SiteKind::edge, e.value}, patch, false);
      for (const std::int32_t v : table.vertices(table.id({SiteKind::face, t}))) {
        set({SiteKind::vertex, static_cast<std::uint32_t>(v)}, patch, false);
      }
    }
    for (const std::uint32_t v : sites[s].vertices) {
      check(v, table.vertex_count());
      set({SiteKind::vertex, v}, patch_of.of_side(number), true);
    }
    if (sites[s].kind != SiteKind::edge) continue;
    if (sites[s].vertices.size() != 2) refuse();
    const Segment ends{sites[s].vertices[0], sites[s].vertices[1]};
    const auto at = std::lower_bound(table.edges().begin(), table.edges().end(), ends);
    if (at == table.edges().end() || *at != ends) refuse();
    set({SiteKind::edge, static_cast<std::uint32_t>(at - table.edges().begin())}, patch_of.of_side(number), true);
  }
  return out;
}

/// Point of the surface to which the distance from a query has a local minimum.
struct Contact {
  Vec3d direction;  ///< from the query to the point, a unit vector
  std::int32_t patch = outside;
};

/// Finds the patches on the two sides of a point near the medial axis.
class Governors {
 public:
  Governors(const MeshView& mesh, std::vector<std::int32_t> patch_of, SiteTable table, const Context& context)
      : mesh_(mesh), table_(std::move(table)), patch_of_(std::move(patch_of)), bvh_(mesh, table_, context) {
    triangles_at_.assign(table_.size(), 0);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      ++triangles_at_[table_.id({SiteKind::face, t}).value];
      for (const EdgeId e : table_.triangle_edges()[t]) ++triangles_at_[table_.id({SiteKind::edge, e.value}).value];
      for (const std::uint32_t v : mesh.triangles[t]) ++triangles_at_[table_.id({SiteKind::vertex, v}).value];
    }
  }

  /// Returns both patches, the smaller number first. The two patches are equal if no second contact is found.
  /// @param angle  least angle between the two contacts, degrees.
  /// @param reach  largest distance of the second contact.
  [[nodiscard]] std::array<std::int32_t, 2> at(const Vec3d& query, double angle, double reach) const {
    const std::optional<NearestSite> nearest = bvh_.nearest(query);
    if (!nearest) return {outside, outside};
    const Contact first{direction_to(nearest->point, query), patch_of_[nearest->site.value]};
    // Few primitives lie just beyond the closest one, so the search widens in steps.
    double beyond = std::max(0.01 * nearest->distance, 1e-9 * reach);
    for (double radius = 0; radius < reach; beyond *= 2) {
      radius = std::min(nearest->distance + beyond, reach);
      const std::int32_t second = second_patch(query, radius, first, angle);
      if (second != outside) return {std::min(first.patch, second), std::max(first.patch, second)};
    }
    return {first.patch, first.patch};
  }

 private:
  static Vec3d direction_to(const Vec3d& point, const Vec3d& query) {
    const Vec3d way = point - query;
    const double size = length(way);
    return size > 0 ? way / size : Vec3d{};
  }

  [[nodiscard]] bool faces(std::uint32_t triangle, const Vec3d& direction) const {
    const auto [a, b, c] = triangle_corners(mesh_, triangle);
    return dot(cross(b - a, c - a), direction) > 0;
  }

  /// Returns the patch of the closest contact that is seen under an angle of at least `angle` from the first one.
  [[nodiscard]] std::int32_t second_patch(const Vec3d& query, double radius, const Contact& first, double angle) const {
    std::vector<NearestPrimitive> near = bvh_.within(query, radius);
    // Primitives with the same closest point stand next to each other. The order of distances is kept.
    struct Place {
      double distance;
      SiteId site;
      Vec3d point;
      std::uint32_t triangles = 0;
      bool is_facing = false;
    };
    std::sort(near.begin(), near.end(), [](const NearestPrimitive& a, const NearestPrimitive& b) {
      return std::pair(a.site.value, a.primitive) < std::pair(b.site.value, b.primitive);
    });
    std::vector<Place> places;
    for (const NearestPrimitive& one : near) {
      if (places.empty() || places.back().site != one.site) places.push_back({one.distance, one.site, one.point});
      ++places.back().triangles;
      if (faces(one.primitive, one.point - query)) places.back().is_facing = true;
    }
    const double least_cosine = std::cos(angle / to_degrees);
    const Place* best = nullptr;
    for (const Place& place : places) {
      // The distance has a local minimum if no triangle at the site has a closer point.
      if (!place.is_facing || place.triangles != triangles_at_[place.site.value]) continue;
      if (best != nullptr && best->distance <= place.distance) continue;
      const Vec3d way = direction_to(place.point, query);
      if (dot(way, first.direction) <= least_cosine) best = &place;
    }
    return best == nullptr ? outside : patch_of_[best->site.value];
  }

  const MeshView mesh_;
  SiteTable table_;
  std::vector<std::int32_t> patch_of_;       ///< for each site of the mesh
  std::vector<std::uint32_t> triangles_at_;  ///< for each site of the mesh: number of triangles that contain it
  Bvh bvh_;
};

void set_column(Complex& axis, std::string_view name, std::vector<std::int32_t> values) {
  axis.triangle_columns.erase(name);
  axis.triangle_columns.add({std::string(name), 1, std::move(values)});
}

}  // namespace

void add_axis_patch_columns(Complex& axis, const MeshView& mesh, std::span<const VoronoiSite> sites,
                            std::span<const VoronoiPatch> patches, const Context& context) {
  validate(axis);
  validate(mesh);
  if (!axis.positions.empty() && axis.vertex_columns.find(medial_columns::radius) == nullptr) {
    throw InvalidOption(missing_medial_column("vertices", medial_columns::radius));
  }
  SiteTable table(mesh, context);
  std::vector<std::int32_t> patch_of = patches_of_sites(table, sites, patches);
  const Governors governors(mesh, std::move(patch_of), std::move(table), context);
  const CompleteAxis all(axis);
  const MedialView view(all.get());
  std::array<std::vector<std::int32_t>, 2> columns;
  for (std::vector<std::int32_t>& column : columns) column.resize(axis.triangles.size(), outside);
  parallel_for(context, axis.triangles.size(), triangles_per_range, "patches", [&](const WorkRange& range) {
    for (std::size_t t = range.begin; t < range.end; ++t) {
      const auto& [a, b, c] = axis.triangles[t];
      const Vec3d middle = (axis.positions[a] + axis.positions[b] + axis.positions[c]) / 3;
      double reach = 0;
      for (const std::uint32_t v : axis.triangles[t]) {
        reach = std::max(reach, view.radius[v] + length(axis.positions[v] - middle));
      }
      const double angle = std::max(least_angle, 0.5 * static_cast<double>(view.triangle_angle[t]));
      const std::array<std::int32_t, 2> found = governors.at(middle, angle, (1 + 1e-9) * reach);
      for (std::size_t k = 0; k < 2; ++k) columns[k][t] = found[k];
    }
  });
  for (std::size_t k = 0; k < 2; ++k) set_column(axis, medial_columns::patches[k], std::move(columns[k]));
}

void add_axis_patch_columns(Complex& axis, const Solid& solid, const VoronoiPatchOptions& options,
                            const Context& context) {
  check_manifold(solid);
  const MeshView mesh = solid.surface().mesh;
  const std::vector<VoronoiSite> sites = voronoi_sites(mesh, context);
  add_axis_patch_columns(axis, mesh, sites, voronoi_patches(mesh, sites, options, context), context);
}

}  // namespace blum
