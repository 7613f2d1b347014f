#include "geometry/topology/shells.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "blum/core/union_find.hpp"
#include "geometry/box_scale.hpp"
#include "geometry/predicates/expansion.hpp"

namespace blum::detail {
namespace {

/// Sums of area and volume. Coordinates are taken relative to an origin and scaled by a power of two. So shapes that
/// are far away, huge or tiny lose no digits.
struct Measure {
  Vec3d origin;
  double scale = 1;
  double area = 0;
  double volume = 0;

  void set_frame(const Box3& bounds) {
    origin = bounds.lower;
    scale = scale_to_one(bounds.diagonal());
  }
  void add(const MeshView& mesh, const Triangle& t) {
    const Vec3d a = (mesh.vertices[t[0]] - origin) * scale;
    const Vec3d b = (mesh.vertices[t[1]] - origin) * scale;
    const Vec3d c = (mesh.vertices[t[2]] - origin) * scale;
    const Vec3d normal = cross(b - a, c - a);
    area += 0.5 * length(normal);
    volume += dot(a, normal) / 6;
  }
  /// Returns true if the sign of the volume may be due to rounding.
  [[nodiscard]] bool is_doubtful() const { return !(std::abs(volume) > 1e-13 * area); }
  [[nodiscard]] int sign() const { return volume > 0 ? 1 : volume < 0 ? -1 : 0; }
};

/// Returns the volume of a shell, computed exactly and rounded at the end. (For a thin shell, the volume is a small
/// difference of large sums.)
double exact_volume(const MeshView& mesh, std::span<const std::uint32_t> triangles, double scale,
                    const Context& context) {
  Expansion<unbounded> six_fold;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (i % 4096 == 0) throw_if_cancelled(context);
    const auto& [a, b, c] = mesh.triangles[triangles[i]];
    six_fold.add_determinant(1, mesh.vertices[a] * scale, mesh.vertices[b] * scale, mesh.vertices[c] * scale);
  }
  return six_fold.value() / 6;
}

/// Replaces volumes with uncertain signs by exact ones.
void settle_volumes(const MeshView& mesh, const ShellSet& set, std::vector<Measure>& measures, const Context& context) {
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (set.of_triangle[t] != no_component && measures[set.of_triangle[t]].is_doubtful()) triangles.push_back(t);
  }
  if (triangles.empty()) return;
  std::sort(triangles.begin(), triangles.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(set.of_triangle[a], a) < std::pair(set.of_triangle[b], b);
  });
  for (std::size_t begin = 0, end = 0; begin < triangles.size(); begin = end) {
    const std::uint32_t shell = set.of_triangle[triangles[begin]];
    while (end < triangles.size() && set.of_triangle[triangles[end]] == shell) ++end;
    const double scale = coordinate_scale(set.shells[shell].bounds);
    const double factor = measures[shell].scale / scale;
    measures[shell].volume =
        exact_volume(mesh, std::span(triangles).subspan(begin, end - begin), scale, context) * factor * factor * factor;
  }
}

}  // namespace

std::vector<EdgeTally> tally_edges(const MeshView& mesh, const SiteTable& sites) {
  std::vector<EdgeTally> edges(sites.edge_count());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corner = mesh.triangles[t];
    if (names_vertex_twice(corner)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      EdgeTally& edge = edges[sites.triangle_edges()[t][k].value];
      ++edge.count;
      edge.balance += corner[k] < corner[k == 2 ? 0 : k + 1] ? 1 : -1;
      edge.triangle = t;
    }
  }
  return edges;
}

SurfaceComponents find_components(const MeshView& mesh, const SiteTable& sites, std::span<const EdgeTally> edges) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  UnionFind sets(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    if (names_vertex_twice(mesh.triangles[t])) continue;
    for (const EdgeId edge : sites.triangle_edges()[t]) {
      const std::uint32_t other = edges[edge.value].triangle;
      if (other != t) sets.join(t, other);
    }
  }
  SurfaceComponents result;
  result.of_triangle.resize(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    if (names_vertex_twice(mesh.triangles[t])) {
      result.of_triangle[t] = no_component;
      continue;
    }
    const std::uint32_t root = sets.find(t);
    result.of_triangle[t] = root == t ? result.count++ : result.of_triangle[root];
  }
  result.is_closed.assign(result.count, 1);
  result.is_shell.assign(result.count, 1);
  for (const EdgeTally& edge : edges) {
    if (edge.count == 0 || edge.is_consistent()) continue;
    const std::uint32_t component = result.of_triangle[edge.triangle];
    result.is_shell[component] = 0;
    if (edge.count != 2) result.is_closed[component] = 0;
  }
  return result;
}

ShellSet find_shells(const MeshView& mesh, const SurfaceComponents& components, const Context& context) {
  ShellSet set;
  std::vector<std::uint32_t> shell_of(components.count, no_component);
  for (std::uint32_t c = 0; c < components.count; ++c) {
    if (components.is_shell[c] == 0) continue;
    shell_of[c] = static_cast<std::uint32_t>(set.shells.size());
    set.shells.emplace_back();
  }
  set.of_triangle.resize(mesh.triangles.size(), no_component);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t component = components.of_triangle[t];
    if (component == no_component || shell_of[component] == no_component) continue;
    set.of_triangle[t] = shell_of[component];
    Shell& shell = set.shells[shell_of[component]];
    ++shell.triangles;
    for (const std::uint32_t v : mesh.triangles[t]) shell.bounds.extend(mesh.vertices[v]);
  }
  std::vector<Measure> measures(set.shells.size());
  for (std::size_t s = 0; s < measures.size(); ++s) measures[s].set_frame(set.shells[s].bounds);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (set.of_triangle[t] != no_component) measures[set.of_triangle[t]].add(mesh, mesh.triangles[t]);
  }
  throw_if_cancelled(context);
  settle_volumes(mesh, set, measures, context);
  for (std::size_t s = 0; s < measures.size(); ++s) {
    Shell& shell = set.shells[s];
    const double unit = 1 / measures[s].scale;
    shell.area = measures[s].area * unit * unit;
    shell.signed_volume = measures[s].volume * unit * unit * unit;
  }
  (void)nest_shells(mesh, set, context);
  for (std::size_t s = 0; s < measures.size(); ++s) {
    Shell& shell = set.shells[s];
    shell.faces_outwards = measures[s].sign() == (shell.depth % 2 == 0 ? 1 : -1);
  }
  return set;
}

}  // namespace blum::detail
