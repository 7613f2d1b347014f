// Blum: closed meshes that face outwards. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "blum/core/context.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Mesh whose triangles face away from the solid.
struct OrientedMesh {
  TriangleMesh mesh;  ///< The given mesh, with the second and third corner of some triangles exchanged.
  std::size_t reversed_triangles = 0;  ///< Triangles that faced another way than most of their shell.
  std::size_t reversed_shells = 0;     ///< Shells that faced the solid as a whole.
};

/// Returns the same triangles, in their order, all facing away from the solid that they bound. First, triangles that
/// disagree with most of their shell are reversed, then shells that face the solid. Voids are shells at odd depth, as
/// in Shell. The set of points and the numbers of vertices, edges and triangles stay the same.
///
/// If half of a shell's triangles face one way and half the other, its triangle with the smallest number decides.
///
/// @param mesh  closed and manifold: each edge has two triangles. Crossings are not checked. If shells cross, their
///              triangles with the smallest numbers decide which one lies in the other.
/// @throws InvalidMesh if it is not, or has only one side, like a Klein bottle. Also if a shell encloses no volume (or
/// none that a double represents), or shells coincide, so that each lies in the other. Cancelled.
/// Cost: that of topology(), twice if triangles disagree.
[[nodiscard]] OrientedMesh oriented_mesh(const MeshView& mesh, const Context& context = {});

}  // namespace blum
