#include "blum/certificate/certificate.hpp"
#include "certificate/bounding_mesh.hpp"
#include "certificate/shells.hpp"

namespace blum {

MeshSolidRule solid_rule(const MeshView& mesh, const Context& context) {
  validate(mesh);
  try {
    const verifier::BoundingMesh bounding(mesh, context);
    return {SolidRule::polyhedron, bounding.is_resolved()
                                       ? "the mesh is closed, and manifold once its crossings are resolved"
                                       : "the mesh is closed, manifold and does not cross itself"};
  } catch (const verifier::NoPolyhedron& error) {
    return {SolidRule::winding, error.reason()};
  }
}

}  // namespace blum
