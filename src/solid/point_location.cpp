#include "solid/point_location.hpp"

#include <array>
#include <cstdint>
#include <limits>

#include "blum/core/random.hpp"
#include "blum/geometry/orient3d.hpp"
#include "blum/geometry/sites.hpp"

namespace blum::detail {
namespace {

/// A ray in one of a fixed sequence of directions meets an edge of a surface with a chance of nearly 0.
constexpr std::uint32_t most_rays = 64;

TriangleMesh joined(const std::vector<SolidBody>& bodies) {
  TriangleMesh mesh;
  for (const SolidBody& body : bodies) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), body.mesh.vertices.begin(), body.mesh.vertices.end());
    for (Triangle t : body.mesh.triangles) {
      for (std::uint32_t& v : t) v += first;
      mesh.triangles.push_back(t);
    }
  }
  return mesh;
}

}  // namespace

PointLocation::PointLocation(const MeshSolid& solid)
    : is_polyhedron_(solid.rule == SolidRule::polyhedron), mesh_(joined(solid.bodies)) {
  const SiteTable sites(mesh_);
  if (solid.is_closed) {
    bvh_.emplace(mesh_, sites);
  } else {
    winding_.emplace(mesh_, sites);
  }
}

bool PointLocation::contains(const Vec3d& p) const {
  if (winding_) return winding_->is_inside(p);
  Random random(1);
  for (std::uint32_t k = 0; k < most_rays; ++k) {
    const Vec3d direction{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 1)};
    if (const std::optional<bool> found = contains_along(p, direction)) return *found;
  }
  return true;  // on an edge of the surface, from where every ray begins with one
}

std::optional<bool> PointLocation::contains_along(const Vec3d& p, const Vec3d& direction) const {
  int winding = 0;
  bool tells = true;
  bool is_on_surface = false;
  constexpr double no_limit = std::numeric_limits<double>::infinity();
  bvh_->for_each_crossing({p, direction}, no_limit, [&](const RayCrossing& crossing) {
    const Triangle& t = mesh_.triangles[crossing.triangle.value];
    // A ray crosses a plane once: a point in the plane is where.
    is_on_surface = is_on_surface || orient3d(mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]], p) == 0;
    tells = tells && !crossing.on_border;
    winding += crossing.side;
    return is_on_surface ? -1 : no_limit;
  });
  if (is_on_surface && is_polyhedron_) return true;
  if (!tells || is_on_surface) return std::nullopt;
  return winding > 0;
}

}  // namespace blum::detail
