#include "blum/solid/oriented_mesh.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "solid/facing.hpp"

namespace blum {
namespace {

/// Shells at odd depth bound voids of those around them, which are at even depth.
void check_nesting(std::span<const Shell> shells) {
  const bool is_nested = std::all_of(shells.begin(), shells.end(), [&](const Shell& shell) {
    return shell.depth % 2 == 0 || (shell.parent >= 0 && shells[static_cast<std::size_t>(shell.parent)].depth % 2 == 0);
  });
  if (!is_nested)
    throw InvalidMesh("the mesh bounds no solid: its shells do not lie in each other, they coincide or cross");
}

}  // namespace

OrientedMesh oriented_mesh(const MeshView& mesh, const Context& context) {
  validate(mesh);
  OrientedMesh out{copy_of(mesh), 0, 0};
  const SiteTable sites(out.mesh, context);
  Topology facts = topology(out.mesh, sites, context);
  if (facts.closed && facts.inconsistent_edges > 0) {
    auto agreeing = detail::agreeing_triangles(mesh, sites, out.reversed_triangles);
    if (!agreeing) throw InvalidMesh("the mesh bounds no solid: it has one side only, so that it cannot be oriented");
    out.mesh.triangles = std::move(*agreeing);
    facts = topology(out.mesh, SiteTable(out.mesh, context), context);
  }
  if (mesh.triangles.empty() || !(facts.closed && facts.oriented && facts.manifold))
    throw InvalidMesh(problem_as_solid(facts));
  check_nesting(facts.shells);
  if (facts.faces_outwards) return out;
  const std::vector<std::uint32_t> shells = detail::shell_of_triangles(out.mesh, sites);
  for (const Shell& shell : facts.shells) out.reversed_shells += shell.faces_outwards ? 0U : 1U;
  for (std::size_t t = 0; t < shells.size(); ++t) {
    if (shells[t] == detail::no_shell || facts.shells[shells[t]].faces_outwards) continue;
    std::swap(out.mesh.triangles[t][1], out.mesh.triangles[t][2]);
  }
  if (!topology(out.mesh, SiteTable(out.mesh, context), context).faces_outwards) {
    throw InvalidMesh("the mesh bounds no solid: a shell of it encloses no volume, so that it faces nowhere");
  }
  return out;
}

}  // namespace blum
