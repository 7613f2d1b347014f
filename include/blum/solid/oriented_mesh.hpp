// Blum: closed meshes that face outwards. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "blum/core/context.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// A mesh whose triangles face away from the solid.
struct OrientedMesh {
  TriangleMesh mesh;  ///< the given one, but that the second and third corner of some triangles have changed places
  std::size_t reversed_triangles = 0;  ///< that faced another way than most of their shell
  std::size_t reversed_shells = 0;     ///< that faced the solid, as a whole
};

/// The same triangles, in their order, turned such that all face away from the solid that they bound: first those that
/// disagree with most of their shell, then shells that face the solid. Voids are shells at odd depth, as Shell says.
/// As a set of points the mesh stays what it is, and so do all numbers of its vertices, edges and triangles.
///
/// Where half of a shell's triangles face one way and half the other, its triangle of the smallest number decides.
///
/// @param mesh  closed and manifold: each edge has two triangles. Whether it crosses itself is not asked; where shells
///              cross, which one lies in another is that of their triangles of the smallest number.
/// @throws InvalidMesh where it is not, has one side only, as a Klein bottle, where a shell encloses no volume (or none
/// that a double holds), and where shells coincide, so that each lies in the other; Cancelled.
/// Cost: that of topology(), twice where triangles disagree.
[[nodiscard]] OrientedMesh oriented_mesh(const MeshView& mesh, const Context& context = {});

}  // namespace blum
