// Blum: patches of the surface on both sides of a medial axis. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/solid/solid.hpp"
#include "blum/voronoi/voronoi_patches.hpp"
#include "blum/voronoi/voronoi_sites.hpp"

namespace blum {

/// Adds the columns `patch_a` and `patch_b` (int32) to the triangles of any medial axis of a polyhedron, for example of
/// medial_axis(). The columns are the governors of a triangle: the patches of the surface on its two sides, the smaller
/// number first. If both sides face the same patch, the two numbers are equal. Patches are numbered as by
/// add_patch_columns() for a Voronoi diagram of the same mesh. label_patch_sheets() then adds the sheets between pairs
/// of patches. Existing columns of these names are replaced.
///
/// For the middle of each triangle, the function searches contacts. A contact is a point of the surface that faces the
/// middle, and at which the distance from the middle has a local minimum. The closest contact gives one patch. The next
/// contact gives the other patch, if the angle between the two contacts is at least half the separation angle of the
/// triangle. So adjacent facets on one side of a sheet are not taken for two sides.
///
/// A triangle that crosses the border between two pairs of patches gets the pair at its middle. Decimated axes have
/// triangles across borders, because a sheet continues smoothly from one pair of patches to the next. If the exact
/// borders matter, use an axis with all vertices.
/// @param axis     vertices with the column `radius`, triangles with `separation_angle`. If `separation_angle` is
/// missing, all angles are 0.
/// @param mesh     as for polyhedron_sites().
/// @param sites    result of voronoi_sites() for this mesh.
/// @param patches  result of voronoi_patches() for these sites.
/// @throws InvalidOption if radii are missing. InvalidOption if sites or patches are not those of the mesh. InvalidMesh
/// with the text of problem_of(axis); InvalidMesh as polyhedron_sites(); Cancelled.
/// Cost: O(n log n) for n triangles of the mesh, and about 5 us per triangle of the axis.
void add_axis_patch_columns(Complex& axis, const MeshView& mesh, std::span<const VoronoiSite> sites,
                            std::span<const VoronoiPatch> patches, const Context& context = {});

/// Adds the columns for an axis of a solid. The sites and patches are those of the solid's surface, as in
/// voronoi_complex() of this solid.
/// @throws InvalidOption if an option is out of range; as check_manifold(), which rejects solids of images; as
/// add_axis_patch_columns() of a mesh.
void add_axis_patch_columns(Complex& axis, const Solid& solid, const VoronoiPatchOptions& options = {},
                            const Context& context = {});

}  // namespace blum
