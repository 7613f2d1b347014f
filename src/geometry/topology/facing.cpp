#include "blum/geometry/facing.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "geometry/topology/shells.hpp"

namespace blum::detail {
namespace {

constexpr std::uint32_t nobody = 0xffffffffU;
constexpr std::uint32_t crowded = 0xfffffffeU;  ///< instead of the second triangle of an edge with more than two

/// Walks over edges with two triangles, and reverses triangles so that neighbours have consistent orientations.
class Reverser {
 public:
  Reverser(const MeshView& mesh, const SiteTable& sites)
      : mesh_(mesh),
        sites_(sites),
        of_edge_(sites.edge_count(), {nobody, nobody}),
        facing_(mesh.triangles.size(), 0),
        triangles_(mesh.triangles.begin(), mesh.triangles.end()) {
    for (std::uint32_t t = 0; t < facing_.size(); ++t) {
      if (names_vertex_twice(mesh.triangles[t])) continue;
      for (const EdgeId edge : sites.triangle_edges()[t]) {
        auto& pair = of_edge_[edge.value];
        if (pair[0] == nobody) {
          pair[0] = t;
        } else if (pair[1] == nobody) {
          pair[1] = t;
        } else {
          pair[1] = crowded;
        }
      }
    }
  }

  std::optional<std::vector<Triangle>> agreeing(std::size_t& count) {
    for (std::uint32_t first = 0; first < facing_.size(); ++first) {
      if (facing_[first] != 0 || names_vertex_twice(mesh_.triangles[first])) continue;
      if (!agree_with(first)) return std::nullopt;
    }
    count = count_;
    return std::move(triangles_);
  }

  /// If a patch cannot be oriented, its triangles stay as they are.
  std::vector<Triangle> agreeing_patches() {
    for (std::uint32_t first = 0; first < facing_.size(); ++first) {
      if (facing_[first] == 0 && !names_vertex_twice(mesh_.triangles[first])) (void)agree_with(first);
    }
    return std::move(triangles_);
  }

 private:
  bool agree_with(std::uint32_t first) {
    std::vector<std::uint32_t> shell{first};
    facing_[first] = 1;
    int sum = 0;
    bool is_orientable = true;
    for (std::size_t next = 0; next < shell.size(); ++next) {
      sum += facing_[shell[next]];
      is_orientable = visit_neighbours(shell[next], shell) && is_orientable;
    }
    if (!is_orientable) return false;
    for (const std::uint32_t t : shell) {
      if ((facing_[t] > 0) == (sum >= 0)) continue;
      std::swap(triangles_[t][1], triangles_[t][2]);
      ++count_;
    }
    return true;
  }

  /// Sets the orientation of a triangle's neighbours. Returns false if a neighbour already has the opposite
  /// orientation.
  bool visit_neighbours(std::uint32_t t, std::vector<std::uint32_t>& shell) {
    bool agrees = true;
    for (const EdgeId edge : sites_.triangle_edges()[t]) {
      const auto& pair = of_edge_[edge.value];
      if (pair[1] == crowded) continue;
      const std::uint32_t other = pair[0] == t ? pair[1] : pair[0];
      if (other == nobody || other == t) continue;
      const int wanted = rises(t, edge) != rises(other, edge) ? facing_[t] : -facing_[t];
      agrees = agrees && facing_[other] != -wanted;
      if (facing_[other] != 0) continue;
      shell.push_back(other);
      facing_[other] = wanted;
    }
    return agrees;
  }

  /// Returns true if a triangle traverses an edge from its smaller vertex to its larger one.
  [[nodiscard]] bool rises(std::uint32_t t, EdgeId edge) const {
    for (std::size_t k = 0; k < 3; ++k) {
      if (sites_.triangle_edges()[t][k] == edge) return mesh_.triangles[t][k] < mesh_.triangles[t][(k + 1) % 3];
    }
    return false;
  }

  const MeshView& mesh_;
  const SiteTable& sites_;
  std::vector<std::array<std::uint32_t, 2>> of_edge_;
  std::vector<int> facing_;  ///< for each triangle: 1, -1 if it is to be reversed, 0 if unknown
  std::vector<Triangle> triangles_;
  std::size_t count_ = 0;  ///< number of reversed triangles
};

/// Returns for each shell whether its outermost shell has a negative volume.
std::vector<bool> are_inside_out(std::span<const Shell> shells) {
  std::vector<bool> out(shells.size());
  for (std::size_t s = 0; s < shells.size(); ++s) {
    std::size_t outermost = s;
    // Shells that coincide may be each other's parents.
    for (std::size_t n = 0; n < shells.size() && shells[outermost].parent >= 0; ++n) {
      outermost = static_cast<std::size_t>(shells[outermost].parent);
    }
    out[s] = shells[outermost].signed_volume < 0;
  }
  return out;
}

}  // namespace

std::vector<std::uint32_t> shell_of_triangles(const MeshView& mesh, const SiteTable& sites) {
  return find_components(mesh, sites, tally_edges(mesh, sites)).of_triangle;
}

std::optional<std::vector<Triangle>> agreeing_triangles(const MeshView& mesh, const SiteTable& sites,
                                                        std::size_t& count) {
  return Reverser(mesh, sites).agreeing(count);
}

std::vector<Triangle> agreeing_patches(const MeshView& mesh, const SiteTable& sites) {
  return Reverser(mesh, sites).agreeing_patches();
}

std::optional<RepairedFacing> repaired_facing(const MeshView& mesh, const SiteTable& sites, const Orientation& given,
                                              const Context& context) {
  if (!given.closed || (given.oriented && given.outward)) return std::nullopt;
  RepairedFacing out;
  if (given.oriented) {
    out.triangles.assign(mesh.triangles.begin(), mesh.triangles.end());
  } else {
    std::optional<std::vector<Triangle>> agreeing = agreeing_triangles(mesh, sites, out.reversed_triangles);
    if (!agreeing) return std::nullopt;
    out.triangles = std::move(*agreeing);
  }
  const MeshView agreeing{mesh.vertices, out.triangles, mesh.segments, mesh.points};
  std::optional<SiteTable> table;
  const SiteTable& own = given.oriented ? sites : table.emplace(agreeing, context);
  const SurfaceComponents components = find_components(agreeing, own, tally_edges(agreeing, own));
  const auto [shells, of_triangle] = find_shells(agreeing, components, context);
  const std::vector<bool> is_reversed = are_inside_out(shells);
  for (std::size_t t = 0; t < of_triangle.size(); ++t) {
    if (of_triangle[t] != no_component && is_reversed[of_triangle[t]])
      std::swap(out.triangles[t][1], out.triangles[t][2]);
  }
  out.reversed_shells = static_cast<std::size_t>(std::count(is_reversed.begin(), is_reversed.end(), true));
  return out.reversed_triangles + out.reversed_shells > 0 ? std::optional(std::move(out)) : std::nullopt;
}

double volume_around_middle(const MeshView& mesh) {
  const Vec3d middle = bounds(mesh).center();
  double volume = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = mesh.vertices[t[0]] - middle;
    volume += dot(a, cross(mesh.vertices[t[1]] - middle, mesh.vertices[t[2]] - middle));
  }
  return volume;
}

}  // namespace blum::detail
