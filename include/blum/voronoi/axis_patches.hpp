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
/// medial_axis(). They are the governors of a triangle: the patches of the surface on its two sides, the smaller number
/// first. Inside a patch, both are equal. Patches are numbered as by add_patch_columns() for a Voronoi diagram of the
/// same mesh. label_patch_sheets() then adds the sheets of pairs of patches. If the axis has the columns already, they
/// are replaced.
///
/// The contacts of the middle of each triangle are searched. A contact is a point of the surface that faces the middle,
/// and at which the distance from the middle has a local minimum. The closest contact gives one patch. The next contact
/// gives the other patch, if the angle between both is at least half the separation angle of the triangle. So facets
/// that lie next to each other on one side of a sheet do not count as two sides.
///
/// A triangle that lies between several pairs gets the pair at its middle. This concerns decimated axes, where a sheet
/// continues smoothly from one pair to the next. So use an axis with all vertices where such borders matter.
/// @param axis     vertices with the column `radius`, triangles with `separation_angle`. Without the latter, angles
/// count as 0.
/// @param mesh     as for polyhedron_sites().
/// @param sites    result of voronoi_sites() for this mesh.
/// @param patches  result of voronoi_patches() for these sites.
/// @throws InvalidOption if radii are missing. InvalidOption if sites or patches are not those of the mesh. InvalidMesh
/// with the text of problem_of(axis); InvalidMesh as polyhedron_sites(); Cancelled.
/// Cost: O(n log n) for n triangles of the mesh, and about 5 us per triangle of the axis.
void add_axis_patch_columns(Complex& axis, const MeshView& mesh, std::span<const VoronoiSite> sites,
                            std::span<const VoronoiPatch> patches, const Context& context = {});

/// Does the same with the sites and patches of the surface of a solid, as voronoi_complex() of this solid has them.
/// @throws InvalidOption if an option is out of range; as check_manifold(), so also for solids of images; as above.
void add_axis_patch_columns(Complex& axis, const Solid& solid, const VoronoiPatchOptions& options = {},
                            const Context& context = {});

}  // namespace blum
