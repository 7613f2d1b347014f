// Blum: separation angles of the cells of a solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "blum/grid/voxel_set.hpp"
#include "medial_axis/cells/importance.hpp"
#include "medial_axis/surface/governors.hpp"

namespace blum::detail {

/// Returns the voxels of the box that have a voxel of the set at most `within` steps away along each axis.
/// @param within  voxels, 0 to 32.
[[nodiscard]] VoxelSet spread(const VoxelSet& from, int within, const Context& context);

/// Criteria that distinguish a piece of the medial axis from noise of the grid and of facets, given two footprints.
struct NoiseFloor {
  double angle = 10;        ///< Degrees. Smaller separation angles count as zero.
  double clear_angle = 45;  ///< Degrees. From here on, the distance of the footprints does not matter.
  double voxels = 2;        ///< Long sides of voxels. At smaller angles, closer footprints count as one.
  /// At clear angles, footprints closer than `voxels` count only if no voxel within this many is deeper than that. This
  /// holds in thin parts, but not at the steps that voxels make of a round surface. 0: they count everywhere.
  int thin_within = 0;
  /// Degrees: points off the lines between voxels count if they see this much more than points on such lines around
  /// them.
  double clearly_more = 5;
  double lambda = 0;  ///< mesh units; closer footprints count as one at any angle
};

/// Computes the separation angle of each cell of a solid, in degrees. This is the largest one at a point of the medial
/// axis within half a voxel of the cell. In parts that pass between all voxels, 0.7 voxels are allowed. The angle is 0
/// if no such point is found.
///
/// A square lies between two voxels. The parts of the surface closest to these are followed to the same point between
/// the two. If they remain two parts, they give the angle. Edges and vertices also look for a point equally far from
/// the footprints of all voxels around them. Axes of round parts cross no line between two voxels.
/// @param complex  of the solid's voxels.
[[nodiscard]] Importance separation_angles(const GovernorField& governors, const CellComplex& complex,
                                           const NoiseFloor& floor, const Context& context);

}  // namespace blum::detail
