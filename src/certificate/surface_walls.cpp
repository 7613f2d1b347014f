#include "certificate/surface_walls.hpp"

#include <cmath>
#include <cstddef>
#include <map>

#include "blum/core/union_find.hpp"
#include "blum/core/vec3.hpp"
#include "certificate/triangle_search.hpp"

namespace blum::verifier {
namespace {

constexpr double cosine_of_flat = 0.99984769515639124;    ///< of 1 degree
constexpr double cosine_of_smooth = 0.86602540378443865;  ///< of 30 degrees
constexpr double large_part = 1.0 / 256;                  ///< of the surface of its body

/// Returns normals that all point out of their shells, or all into them. Their lengths are twice the areas.
std::vector<Vec3d> normals_of(const MeshView& mesh, std::span<const std::int8_t> outwards) {
  std::vector<Vec3d> normals;
  normals.reserve(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = corners_of(mesh, t);
    normals.push_back(cross(b - a, c - a) * static_cast<double>(outwards[t]));
  }
  return normals;
}

}  // namespace

SurfaceWalls::SurfaceWalls(const MeshView& mesh, const ClosedShells& shells, std::span<const std::uint32_t> body_of) {
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  const std::vector<Vec3d> normals = normals_of(mesh, shells.outwards);
  detail::UnionFind flat(count);
  detail::UnionFind smooth(count);
  for (std::uint32_t side = 0; side < 3 * count; ++side) {
    const std::uint32_t t = side / 3;
    const std::uint32_t next = shells.beside[side];
    if (body_of[t] == no_group || body_of[next] == no_group) continue;
    const Vec3d& own = normals[t];
    const Vec3d& other = normals[next];
    // A triangle without area bends nothing.
    const double sizes = length(own) * length(other);
    const double cosine = sizes > 0 ? dot(own, other) / sizes : 1;
    if (cosine >= cosine_of_flat) flat.join(t, next);
    if (cosine >= cosine_of_smooth) smooth.join(t, next);
  }
  std::vector<double> area(count, 0);
  std::map<std::uint32_t, double> of_body;
  for (std::uint32_t t = 0; t < count; ++t) {
    area[flat.find(t)] += length(normals[t]);
    of_body[body_of[t]] += length(normals[t]);
  }
  wall_.reserve(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    const std::uint32_t own = flat.find(t);
    const bool is_large = area[own] >= large_part * of_body[body_of[t]];
    flat_part_.push_back(own);
    smooth_part_.push_back(smooth.find(t));
    wall_.push_back(is_large ? own : count + smooth_part_.back());
  }
}

}  // namespace blum::verifier
