// Blum: closed meshes that face outwards. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "blum/core/context.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Mesh whose triangles face away from the solid.
struct OrientedMesh {
  TriangleMesh mesh;  ///< The given mesh, with the second and third corner of some triangles exchanged.
  std::size_t reversed_triangles = 0;  ///< Triangles that faced against the majority of their shell.
  std::size_t reversed_shells = 0;     ///< Shells that, as a whole, faced into the solid.
};

/// Returns the triangles of a mesh in their order, all facing away from the solid that they bound. First, triangles
/// that face against the majority of their shell are reversed. Then, shells that face into the solid are reversed.
/// Shells at odd depth (Shell::depth) bound voids. The surface as a set of points does not change, and neither do the
/// indices of vertices, edges and triangles.
///
/// If equal numbers of a shell's triangles face in the two directions, the triangle with the smallest index decides.
///
/// @param mesh  closed and manifold: each edge has two triangles. Crossings are not detected. If two shells cross, the
///              triangle with the smallest index in each shell decides which shell counts as the inner shell.
/// @throws InvalidMesh if the mesh is not closed and manifold, or has only one side, like a Klein bottle. InvalidMesh
/// is also thrown if a shell encloses no volume (or a volume that no double represents), or if two shells coincide.
/// Cancelled.
/// Cost: that of topology(), or twice that if triangles of a shell face different ways.
[[nodiscard]] OrientedMesh oriented_mesh(const MeshView& mesh, const Context& context = {});

}  // namespace blum
