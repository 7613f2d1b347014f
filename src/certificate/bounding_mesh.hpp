// Blum: the mesh whose shells bound a solid, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "blum/certificate/certificate.hpp"
#include "blum/core/context.hpp"
#include "blum/geometry/resolve_crossings.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::verifier {

/// A mesh that bounds a polyhedron as it is; or, where it crosses or touches itself, what resolve_crossings() makes of
/// it, if that does bound one by the verifier's own reading, with the same inside as the mesh at thousands of points.
class BoundingMesh {
 public:
  /// @param mesh  must stay. @throws InvalidMesh, NoPolyhedron where neither bounds one, Cancelled.
  BoundingMesh(const MeshView& mesh, const Context& context);

  [[nodiscard]] MeshView view() const { return resolved_ ? resolved_->mesh.view() : mesh_; }
  [[nodiscard]] bool is_resolved() const { return resolved_.has_value(); }

 private:
  MeshView mesh_;
  std::optional<ResolvedMesh> resolved_;
};

/// What solid_rule() says of a mesh that bounds a polyhedron.
[[nodiscard]] MeshSolidRule rule_of_polyhedron(bool is_resolved);

}  // namespace blum::verifier
