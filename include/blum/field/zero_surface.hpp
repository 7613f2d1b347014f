// Blum: level surfaces of fields. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Computes the surface at which a field equals a level. For level 0 and a signed field, it is the boundary of the
/// shape.
///
/// Each cube of eight nodes is cut into the six tetrahedra around its diagonal. The distance is linear in each of them
/// (marching tetrahedra; Doi, Koide 1991). Nodes below the level are inside. All others are outside, also those exactly
/// at the level. Triangles face outwards, towards larger values, also if the grid's direction mirrors.
///
/// @param field  field.grid must have at least two layers along each axis. field.distance must be finite; field.site is
///               ignored. If the field has a band, the level must lie within it for a meaningful surface.
/// @param level  finite, mesh units.
/// @return       a consistently oriented manifold that does not cross itself. It is closed, unless the surface leaves
///               the grid: there it is open. It has no triangles if the field does not cross the level. Each edge of a
///               tetrahedron that crosses the level has one vertex, shared by its triangles. Such an edge is a grid
///               edge, a diagonal of a cube's face, or a cube's diagonal. Vertices are numbered in the order of the
///               nodes. A vertex lies where the distance, linear along its edge, equals the level. It is at least a
///               thousandth of the edge away from both ends. So no two vertices coincide where a node is exactly at the
///               level. Near a smooth part of a surface, the result is within O(spacing^2) and a thousandth of a cube's
///               diagonal of it. The bytes are the same for any number of threads.
/// @throws InvalidGrid, also for a grid with a single layer.
/// @throws InvalidOption, also for another count of distances than nodes, or a distance or level that is not finite.
/// @throws InvalidOption for a surface of more than max_id_count vertices or triangles.
/// @throws OutOfMemory, Cancelled.
/// Cost: O(nodes); about 0.1 s for 256^3 on one core. Beside the mesh, it takes 10 bytes per node of one slice and
/// thread.
[[nodiscard]] TriangleMesh zero_surface(const Field& field, double level = 0, const Context& context = {});

}  // namespace blum
