#include "medial_axis/surface/void_points.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "blum/core/union_find.hpp"
#include "blum/geometry/orient3d.hpp"

namespace blum::detail {
namespace {

constexpr std::size_t most_chords = 32;

/// Returns the triangles of each shell that faces inwards, by ascending first vertex. Such shells enclose voids.
std::vector<std::vector<std::uint32_t>> walls_of_voids(const MeshView& mesh) {
  detail::UnionFind shells(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    shells.join(t[0], t[1]);
    shells.join(t[1], t[2]);
  }
  const auto shell_of = [&](const Triangle& t) { return shells.find(t[0]); };
  const auto is_of_first = [&](const Triangle& t) { return shell_of(t) == shell_of(mesh.triangles[0]); };
  // A body without voids has one shell.
  if (std::all_of(mesh.triangles.begin(), mesh.triangles.end(), is_of_first)) return {};
  struct Shell {
    double volume = 0;  // six times the volume
    std::vector<std::uint32_t> triangles;
  };
  std::map<std::uint32_t, Shell> found;
  for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
    const auto& [a, b, c] = mesh.triangles[k];
    const std::uint32_t first = shell_of(mesh.triangles[k]);
    const Vec3d& origin = mesh.vertices[first];
    Shell& shell = found[first];
    shell.triangles.push_back(k);
    shell.volume += dot(mesh.vertices[a] - origin, cross(mesh.vertices[b] - origin, mesh.vertices[c] - origin));
  }
  std::vector<std::vector<std::uint32_t>> walls;
  for (auto& [first, shell] : found) {
    if (shell.volume < 0) walls.push_back(std::move(shell.triangles));
  }
  return walls;
}

/// Returns the middle of a chord of a void: from the centroid of a triangle, away from the solid, to the first
/// crossing.
std::optional<Vec3d> middle_of_chord(const MeshView& mesh, const Surface& surface, std::uint32_t triangle,
                                     double reach) {
  const Triangle& t = mesh.triangles[triangle];
  const Vec3d centre = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
  const Vec3d outwards = surface.outwards(triangle);
  const Vec3d start = centre + outwards * (1e-9 * reach);
  const Vec3d way = outwards * reach;
  const std::optional<double> end = surface.first_crossing(start, start + way, nullptr);
  if (!end) return std::nullopt;
  return start + way * (0.5 * *end);
}

}  // namespace

std::vector<Vec3d> points_of_voids(const MeshView& mesh, const Surface& surface) {
  std::vector<Vec3d> points;
  for (const std::vector<std::uint32_t>& walls : walls_of_voids(mesh)) {
    Box3 box;
    for (const std::uint32_t wall : walls) {
      for (const std::uint32_t v : mesh.triangles[wall]) box.extend(mesh.vertices[v]);
    }
    std::optional<Vec3d> best;
    double depth_of_best = 0;
    const std::size_t every = (walls.size() + most_chords - 1) / most_chords;
    for (std::size_t k = 0; k < walls.size(); k += every) {
      const std::optional<Vec3d> middle = middle_of_chord(mesh, surface, walls[k], box.diagonal());
      if (!middle) continue;
      const double depth = surface.nearest(*middle, {*middle, walls[k], 7}).distance;
      if (depth <= depth_of_best) continue;
      depth_of_best = depth;
      best = middle;
    }
    if (best) points.push_back(*best);
  }
  std::sort(points.begin(), points.end(), [](const Vec3d& a, const Vec3d& b) { return a.x < b.x; });
  return points;
}

bool holds_any(std::span<const Vec3d> points, const std::array<Vec3d, 4>& tetrahedron) {
  if (points.empty()) return false;
  const auto& [a, b, c, d] = tetrahedron;
  const Vec3d lower = min(min(a, b), min(c, d));
  const Vec3d upper = max(max(a, b), max(c, d));
  const auto first =
      std::lower_bound(points.begin(), points.end(), lower.x, [](const Vec3d& p, double x) { return p.x < x; });
  for (auto p = first; p != points.end() && p->x <= upper.x; ++p) {
    if (min(lower, *p) != lower || max(upper, *p) != upper) continue;
    const int side = detail::orient3d(a, b, c, d);
    if (side == 0) return false;
    const auto is_beyond = [&](const Vec3d& u, const Vec3d& v, const Vec3d& w) {
      return detail::orient3d(u, v, w, *p) == -side;
    };
    if (!is_beyond(a, b, c) && !is_beyond(b, a, d) && !is_beyond(c, b, d) && !is_beyond(a, c, d)) {
      return true;
    }
  }
  return false;
}

bool moves_over_any(std::span<const Vec3d> points, const std::array<Vec3d, 3>& from, const std::array<Vec3d, 3>& to) {
  return holds_any(points, {from[0], from[1], from[2], to[0]}) || holds_any(points, {from[1], from[2], to[0], to[1]}) ||
         holds_any(points, {from[2], to[0], to[1], to[2]});
}

}  // namespace blum::detail
