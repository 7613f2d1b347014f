#include "blum/solid/oriented_mesh.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/geometry/facing.hpp"
#include "blum/geometry/mesh_problems.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "solid/polyhedron.hpp"

namespace blum {
namespace {

[[noreturn]] void refuse(std::string_view problem) {
  throw InvalidMesh(std::string(problem));
}

}  // namespace

OrientedMesh oriented_mesh(const MeshView& mesh, const Context& context) {
  validate(mesh);
  const SiteTable sites(mesh, context);
  detail::Facing facing = detail::face_one_way(mesh, sites, context);
  const Topology& facts = facing.facts;
  if (facing.is_one_sided) refuse(mesh_problem::one_sided);
  if (mesh.triangles.empty() || !(facts.closed && facts.oriented && facts.manifold)) refuse(problem_as_solid(facts));
  if (!detail::are_nested(facts.shells)) refuse(mesh_problem::not_nested);
  OrientedMesh out{copy_of(mesh), facing.reversed_triangles, 0};
  if (facing.triangles) out.mesh.triangles = std::move(*facing.triangles);
  if (facts.faces_outwards) return out;
  const std::vector<std::uint32_t> shells = detail::shell_of_triangles(out.mesh, sites);
  for (const Shell& shell : facts.shells) out.reversed_shells += shell.faces_outwards ? 0U : 1U;
  for (std::size_t t = 0; t < shells.size(); ++t) {
    if (shells[t] == detail::no_shell || facts.shells[shells[t]].faces_outwards) continue;
    std::swap(out.mesh.triangles[t][1], out.mesh.triangles[t][2]);
  }
  if (!topology(out.mesh, SiteTable(out.mesh, context), context).faces_outwards) refuse(mesh_problem::no_volume);
  return out;
}

}  // namespace blum
