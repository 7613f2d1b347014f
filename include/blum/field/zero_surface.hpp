// Blum: level surfaces of fields. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// The surface where a field equals a level: for level 0 and a signed field, the boundary of the shape.
///
/// Each cube of eight nodes is cut into the six tetrahedra around its diagonal, and the distance is linear in each
/// (marching tetrahedra; Doi, Koide 1991). Nodes below the level are inside, all others (also those at exactly the
/// level) outside. Triangles face outwards: towards larger values, also where the grid's direction mirrors.
///
/// @param field  field.grid has at least two layers along each axis; field.distance must be finite. field.site is not
///               looked at. Where the field has a band, the level must lie within it for the surface to mean anything.
/// @param level  finite, mesh units.
/// @return       a consistently oriented manifold that does not cross itself; closed, unless the surface leaves the
///               grid: there it is open. No triangles where the field does not cross the level. One vertex on each
///               edge of a tetrahedron that crosses the level (a grid edge, a diagonal of a cube's face, or a cube's
///               diagonal), shared by its triangles; numbered in the order of the nodes. A vertex lies where the
///               distance along its edge, taken as linear, equals the level, but at least a thousandth of the edge
///               away from both ends: so no two vertices coincide where a node has exactly the level. At a smooth
///               part of a surface, within O(spacing^2) and a thousandth of a cube's diagonal of it. The same bytes
///               for any number of threads.
/// @throws InvalidGrid (also for a grid with a single layer), InvalidOption (also for a distance or level that is not a
/// finite number, and for a surface of more than max_id_count vertices or triangles), OutOfMemory, Cancelled.
/// Cost: O(nodes); about 0.1 s for 256^3 on one core; beside the mesh, 10 bytes per node of one slice and thread.
[[nodiscard]] TriangleMesh zero_surface(const Field& field, double level = 0, const Context& context = {});

}  // namespace blum
