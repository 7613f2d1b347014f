// Blum: level surfaces of fields. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/warning.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Computes the surface at which a field equals a level. For level 0 and a signed field, it is the boundary of the
/// shape.
///
/// Each cube of eight nodes is cut into the six tetrahedra around a diagonal of the cube. The distance is interpolated
/// linearly in each tetrahedron (marching tetrahedra; Doi, Koide 1991). Nodes with a distance below the level are
/// inside. All other nodes are outside, also those exactly at the level. Triangles face outwards, towards larger
/// values, also if the grid's direction mirrors.
///
/// @param field  field.grid must have at least two layers along each axis. field.distance must be finite; field.site is
///               ignored. If the field has a band, the surface is meaningful only if the level lies within the band.
/// @param level  finite, mesh units.
/// @return       a consistently oriented manifold that does not cross itself. The mesh is closed if the surface does
///               not leave the grid; otherwise the mesh has a boundary where the surface leaves the grid. The mesh has
///               no triangles if the field does not cross the level. Each tetrahedron edge that crosses the level has
///               one vertex, which all triangles at that edge share. A tetrahedron edge is a grid edge, a diagonal of a
///               cube's face, or a cube's diagonal. Vertices are numbered in the order of the nodes. A vertex lies
///               where the distance, interpolated linearly along the edge, equals the level. The vertex is at least a
///               thousandth of the edge's length away from both ends. So no two vertices coincide, even if a node is
///               exactly at the level. Where the exact surface is smooth, the error of the result is O(spacing^2) plus
///               at most a thousandth of a cube's diagonal. Near edges and corners of the exact surface, the error of
///               vertices is up to half a cube's diagonal. The bytes are the same for any number of threads.
/// @throws InvalidGrid, also for a grid with a single layer.
/// @throws InvalidOption, also if the numbers of distances and nodes differ, or if a distance or the level is not
/// finite.
/// @throws InvalidOption for a surface of more than max_id_count vertices or triangles.
/// @throws OutOfMemory, Cancelled.
/// Cost: O(nodes): about 0.1 s for 256^3 nodes on one core. In addition to the mesh, each thread takes 10 bytes per
/// node of one slice of the grid.
[[nodiscard]] TriangleMesh zero_surface(const Field& field, double level = 0, const Context& context = {});

/// Returns warnings about the surface that zero_surface() computes. WarningCode::left_out: the surface leaves the grid,
/// so it is cut off there. WarningCode::coarse_grid: for most nodes inside, both neighbours along some axis of the grid
/// are outside, so the shape is too thin for the grid.
/// @throws as zero_surface(). Cost: O(nodes), about 1 ns per node.
[[nodiscard]] std::vector<Warning> level_warnings(const Field& field, double level = 0, const Context& context = {});

}  // namespace blum
