#include "blum/certificate/certificate.hpp"
#include "certificate/bounding_mesh.hpp"
#include "certificate/shells.hpp"

namespace blum {

MeshSolidRule verifier::rule_of_polyhedron(bool is_resolved) {
  return {SolidRule::polyhedron, is_resolved ? "the mesh is closed, and manifold once its crossings are resolved"
                                             : "the mesh is closed, manifold and does not cross itself"};
}

MeshSolidRule solid_rule(const MeshView& mesh, const Context& context) {
  validate(mesh);
  try {
    const verifier::BoundingMesh bounding(mesh, context);
    return verifier::rule_of_polyhedron(bounding.is_resolved());
  } catch (const verifier::NoPolyhedron& error) {
    return {SolidRule::winding, error.reason()};
  }
}

}  // namespace blum
