// Blum: separation angles of the cells of a solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "blum/grid/voxel_set.hpp"
#include "medial_axis/cells/importance.hpp"
#include "medial_axis/surface/governors.hpp"

namespace blum::detail {

/// The voxels of the box with one of a set at most so many steps away along each axis. @param within  voxels, 0 to 32.
[[nodiscard]] VoxelSet spread(const VoxelSet& from, int within, const Context& context);

/// What decides whether two footprints mean a piece of the medial axis, or the noise of a grid and of facets.
struct NoiseFloor {
  double angle = 10;        ///< degrees; smaller separation angles count as zero
  double clear_angle = 45;  ///< from here on, the distance of the footprints does not matter
  double voxels = 2;  ///< footprints closer than this many (long sides of) voxels, at smaller angles, count as one
  /// Footprints closer than `voxels` count, at clear angles, only where no voxel within this many is deeper than that:
  /// in thin parts, and not in the steps that voxels make of a round surface. 0: everywhere.
  int thin_within = 0;
  /// Degrees: points off the lines between voxels count where they see this much more than such points around them.
  double clearly_more = 5;
  double lambda = 0;  ///< mesh units: footprints closer than this count as one at any angle
};

/// The separation angle of each cell of a solid: the largest one at a point of the medial axis within half a voxel of
/// it, in degrees; 0 where no such point shows.
///
/// Squares lie between two voxels: where the parts of the surface that these are closest to, followed to the same point
/// between the two, remain two. Edges and vertices also look for a point as far from the footprints of all voxels
/// around them: axes of round things cross no line between two voxels.
/// @param complex  of the solid's voxels.
[[nodiscard]] Importance separation_angles(const GovernorField& governors, const CellComplex& complex,
                                           const NoiseFloor& floor, const Context& context);

}  // namespace blum::detail
