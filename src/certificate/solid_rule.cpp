#include <string>

#include "blum/core/error.hpp"
#include "blum/geometry/self_intersections.hpp"
#include "certificate/scaling.hpp"
#include "certificate/shells.hpp"
#include "certificate/triangle_search.hpp"

namespace blum {
namespace verifier {
namespace {

constexpr std::size_t most_pairs = 100000;

/// @throws NoPolyhedron
SelfIntersections without_crossings(const MeshView& mesh, const Context& context) {
  SelfIntersections found = find_self_intersections(mesh, most_pairs, context);
  if (found.crossing > 0) throw NoPolyhedron("the mesh crosses itself");
  if (!found.complete) {
    throw NoPolyhedron("the mesh touches itself in more than " + std::to_string(most_pairs) + " places");
  }
  return found;
}

/// @throws NoPolyhedron for a mesh that bounds no polyhedron.
void check_polyhedron(const MeshView& mesh, const Context& context) {
  const ScaledMesh own(mesh, factor_for(bounds(mesh).diagonal()));
  ClosedShells shells = cut_into_shells(own.view, context);
  const SelfIntersections found = without_crossings(mesh, context);
  nest(shells, own.view, TriangleSearch(own.view, shells.of_triangle, context), context);
  const auto body = [&](TriangleId t) { return shells.shells[shells.of_triangle[t.value]].body; };
  for (const TrianglePair& pair : found.pairs) {
    if (body(pair.first) == body(pair.second)) throw NoPolyhedron("the mesh touches itself");
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
  } catch (const verifier::NoPolyhedron& error) {
    return {SolidRule::winding, error.reason()};
  }
  return {SolidRule::polyhedron, "the mesh is closed, manifold and does not cross itself"};
}

}  // namespace blum
