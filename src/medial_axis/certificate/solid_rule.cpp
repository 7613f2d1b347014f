#include <string>

#include "blum/core/error.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "medial_axis/certificate/scaling.hpp"
#include "medial_axis/certificate/shells.hpp"
#include "medial_axis/certificate/triangle_search.hpp"

namespace blum {
namespace verifier {
namespace {

constexpr std::size_t most_pairs = 100000;

/// @throws InvalidMesh
SelfIntersections without_crossings(const MeshView& mesh, const Context& context) {
  SelfIntersections found = find_self_intersections(mesh, most_pairs, context);
  if (found.crossing > 0) throw InvalidMesh("the mesh crosses itself");
  if (!found.complete) {
    throw InvalidMesh("the mesh touches itself in more than " + std::to_string(most_pairs) + " places");
  }
  return found;
}

/// @throws InvalidMesh for a mesh that bounds no polyhedron.
void check_polyhedron(const MeshView& mesh, const Context& context) {
  const ScaledMesh own(mesh, factor_for(bounds(mesh).diagonal()));
  ClosedShells shells = find_shells(own.view, context);
  const SelfIntersections found = without_crossings(mesh, context);
  nest(shells, own.view, TriangleSearch(own.view, shells.of_triangle, context), context);
  const auto body = [&](TriangleId t) { return shells.shells[shells.of_triangle[t.value]].body; };
  for (const TrianglePair& pair : found.pairs) {
    if (body(pair.first) == body(pair.second)) throw InvalidMesh("the mesh touches itself");
  }
}

}  // namespace

void check_crossings(const MeshView& mesh, const Context& context) {
  (void)without_crossings(mesh, context);
}

}  // namespace verifier

MeshSolidRule solid_rule(const MeshView& mesh, const Context& context) {
  validate(mesh);
  try {
    verifier::check_polyhedron(mesh, context);
  } catch (const InvalidMesh& error) {
    return {SolidRule::winding, error.what()};
  }
  return {SolidRule::polyhedron, "the mesh is closed, manifold and does not cross itself"};
}

}  // namespace blum
