// Blum: surfaces that wind once around a solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/solid/solid.hpp"

namespace blum {

/// Returns the surface of the points around which a closed mesh winds once or more, with its present orientation.
/// Shells that lie in each other and face the same way bound the union of both. If the mesh already is that surface,
/// returns it.
///
/// This is Solid::of() for moving meshes. It reverses nothing, and computes no bodies, shells and topology, which would
/// take several times as long.
///
/// @param mesh  must pass validate(mesh). Its segments and points are left out.
/// @param name  name in errors, for example "object 3".
/// @throws InvalidMesh if no triangle exists, or they face inwards as a whole. Also if the mesh is not closed, or its
/// crossings are not resolved. Cancelled.
/// Cost: about 0.3 microseconds per triangle; that of resolve_crossings() if it crosses itself.
[[nodiscard]] SolidSurface winding_surface(TriangleMesh mesh, const std::string& name, const Context& context = {});

/// Checks that a mesh faces outwards.
/// @throws InvalidMesh if it has no triangles, or a negative volume.
/// Cost: linear.
void check_faces_outwards(const MeshView& mesh, const std::string& name);

/// Checks that a mesh is closed.
/// @throws InvalidMesh with advice if it is not.
/// Cost: O(n log n).
void check_is_closed(const MeshView& mesh, const std::string& name);

/// Returns the number of edges that are traversed more often one way than the other. It is 0 for closed meshes, whose
/// winding numbers are whole.
/// Cost: O(n log n).
[[nodiscard]] std::size_t open_edges(const MeshView& mesh);

}  // namespace blum
