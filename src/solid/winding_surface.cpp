#include "blum/solid/winding_surface.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include "blum/geometry/facing.hpp"
#include "blum/geometry/mesh_problems.hpp"
#include "blum/geometry/resolve_crossings.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/weld.hpp"

namespace blum {
namespace {

/// Returns true if the winding number is 1 at all points inside the solid, and 0 elsewhere. Triangles then do not cross
/// or touch each other, and nested shells face outwards and inwards alternately.
bool winds_once(const MeshView& surface, const Context& context) {
  return orientation(surface, SiteTable(surface)).outward && !SelfIntersectionSearch().finds_any(surface, context);
}

}  // namespace

std::size_t open_edges(const MeshView& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> sums;
  for (const Triangle& t : mesh.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      sums[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  const auto is_open = [](const auto& edge) { return edge.second != 0; };
  return static_cast<std::size_t>(std::count_if(sums.begin(), sums.end(), is_open));
}

void check_is_closed(const MeshView& mesh, const std::string& name) {
  const std::size_t open = open_edges(mesh);
  if (open > 0) throw InvalidMesh(mesh_problem::not_closed(name, open, open_edges(weld(mesh)) == 0));
}

void check_faces_outwards(const MeshView& mesh, const std::string& name) {
  if (mesh.triangles.empty()) throw InvalidMesh(mesh_problem::no_triangles_in(name));
  if (detail::volume_around_middle(mesh) < 0) throw InvalidMesh(mesh_problem::faces_inwards(name));
}

SolidSurface winding_surface(TriangleMesh mesh, const std::string& name, const Context& context) {
  mesh.segments.clear();
  mesh.points.clear();
  check_faces_outwards(mesh, name);
  if (winds_once(mesh, context)) return {std::move(mesh), {}, {}};
  ResolvedMesh resolved = resolve_crossings(mesh, {}, context);
  if (resolved.is_resolved()) {
    return {std::move(resolved.mesh), std::move(resolved.vertex_of), std::move(resolved.triangle_of)};
  }
  check_is_closed(mesh, name);
  throw InvalidMesh(mesh_problem::not_resolved(name, resolved.obstacle));
}

}  // namespace blum
