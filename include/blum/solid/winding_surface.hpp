// Blum: surfaces that wind once around a solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/solid/solid.hpp"

namespace blum {

/// Returns the boundary of the set of points around which a closed mesh winds once or more. The mesh keeps its present
/// orientation: no triangle is reversed. If a shell lies inside another shell and both face the same way, only the
/// outer shell remains. If the mesh already is this boundary, the function returns the mesh.
///
/// Use this function instead of Solid::of() for meshes that move. The function computes no bodies, shells or topology,
/// and takes a fraction of the time of Solid::of().
///
/// @param mesh  must pass validate(mesh). Segments and points of the mesh are left out.
/// @param name  name in errors, for example "object 3".
/// @throws InvalidMesh if the mesh has no triangles, or if they face inwards as a whole. InvalidMesh is also thrown if
/// the mesh is not closed, or if its crossings cannot be resolved. Cancelled.
/// Cost: about 0.3 microseconds per triangle. If the mesh crosses itself, the cost of resolve_crossings() is added.
[[nodiscard]] SolidSurface winding_surface(TriangleMesh mesh, const std::string& name, const Context& context = {});

/// Checks that a mesh faces outwards.
/// @throws InvalidMesh if the mesh has no triangles, or a negative volume.
/// Cost: linear.
void check_faces_outwards(const MeshView& mesh, const std::string& name);

/// Checks that a mesh is closed.
/// @throws InvalidMesh if the mesh is not closed. The message contains advice.
/// Cost: O(n log n).
void check_is_closed(const MeshView& mesh, const std::string& name);

/// Returns the number of edges that triangles traverse more often in one direction than in the opposite direction. The
/// number is 0 for closed meshes, whose winding numbers are whole numbers.
/// Cost: O(n log n).
[[nodiscard]] std::size_t open_edges(const MeshView& mesh);

}  // namespace blum
