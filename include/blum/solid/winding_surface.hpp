// Blum: surfaces that wind once around a solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/solid/solid.hpp"

namespace blum {

/// The surface of the points around which a closed mesh winds once or more, as it faces: shells that lie in each other
/// and face the same way bound what is in at least one of them. The mesh itself where that is so already.
///
/// It is Solid::of() for meshes that move: nothing is reversed, and bodies, shells and topology are not looked for,
/// which would take several times as long as this.
///
/// @param mesh  passes validate(mesh). Its segments and points are left out.
/// @param name  what errors call it, such as "object 3".
/// @throws InvalidMesh where there are no triangles, where they face inwards as a whole, where the mesh is not closed
/// and its crossings are not resolved; Cancelled.
/// Cost: about 0.3 microseconds for each triangle; where it crosses itself, that of resolve_crossings().
[[nodiscard]] SolidSurface winding_surface(TriangleMesh mesh, const std::string& name, const Context& context = {});

/// @throws InvalidMesh where a mesh has no triangles, or a negative volume. Cost: linear.
void check_faces_outwards(const MeshView& mesh, const std::string& name);

/// @throws InvalidMesh where a mesh is not closed, with what to do. Cost: O(n log n).
void check_is_closed(const MeshView& mesh, const std::string& name);

/// How many edges of a mesh are traversed more often one way than the other: 0 where it is closed, so that it has whole
/// winding numbers. Cost: O(n log n).
[[nodiscard]] std::size_t open_edges(const MeshView& mesh);

}  // namespace blum
