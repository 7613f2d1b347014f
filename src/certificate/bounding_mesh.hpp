// Blum: the mesh whose shells bound a solid, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "blum/certificate/certificate.hpp"
#include "blum/core/context.hpp"
#include "blum/geometry/resolve_crossings.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::verifier {

/// A mesh that bounds a polyhedron.
///
/// It is the given mesh if that bounds a polyhedron, and otherwise the result of resolve_crossings(). The verifier
/// checks with its own code that the result bounds a polyhedron. It also compares the insides of both meshes at
/// thousands of points.
class BoundingMesh {
 public:
  /// @param mesh  must outlive this object.
  /// @throws InvalidMesh, NoPolyhedron if neither mesh bounds a polyhedron, Cancelled.
  BoundingMesh(const MeshView& mesh, const Context& context);

  [[nodiscard]] MeshView view() const { return resolved_ ? resolved_->mesh.view() : mesh_; }
  [[nodiscard]] bool is_resolved() const { return resolved_.has_value(); }

 private:
  MeshView mesh_;
  std::optional<ResolvedMesh> resolved_;
};

/// Returns the result of solid_rule() for a mesh that bounds a polyhedron.
[[nodiscard]] MeshSolidRule rule_of_polyhedron(bool is_resolved);

}  // namespace blum::verifier
