// Blum: separation angles of the cells of a solid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "blum/grid/voxel_set.hpp"
#include "medial_axis/cells/importance.hpp"
#include "medial_axis/surface/governors.hpp"

namespace blum::detail {

/// Returns the voxels of the box that are at most `within` steps along each axis away from a voxel of the set.
/// @param within  voxels, 0 to 32.
[[nodiscard]] VoxelSet spread(const VoxelSet& from, int within, const Context& context);

/// Limits for two footprints of a point. Two footprints that do not exceed these limits are treated as one, because a
/// grid or the facets of a mesh can cause them.
struct NoiseFloor {
  double angle = 10;  ///< Degrees. Smaller separation angles are treated as zero.
  /// Degrees. At this angle or more, the distance of the footprints does not matter, except by `thin_within`.
  double clear_angle = 45;
  /// Multiples of the longest side of a voxel. Below `clear_angle`, footprints closer together than this count as one.
  double voxels = 2;
  /// At `clear_angle` or more, footprints closer together than `voxels` count as two only in thin parts. A part is thin
  /// if no voxel within `thin_within` voxels is deeper than `voxels`. So footprints at the steps by which voxels
  /// represent a round surface are treated as one. With 0, footprints are treated as two everywhere.
  int thin_within = 0;
  /// Degrees: a point off the lines between voxels counts if its angle exceeds the largest one on nearby lines by at
  /// least this much.
  double clearly_more = 5;
  double lambda = 0;  ///< mesh units: footprints closer together than this are treated as one at any angle
};

/// Computes the separation angle of each cell of a solid, in degrees. It is the largest one found at a point of the
/// medial axis within half a voxel of the cell. In parts that pass between all voxels, the limit is 0.7 voxels. The
/// angle is 0 if no such point is found.
///
/// A square lies between two voxels. The footprints of both are followed along the surface while their points move to
/// one common point between the voxels. If they remain two footprints, they determine the angle. For edges and
/// vertices, the point equally far from the footprints of all voxels around them is also tested. Axes of round parts
/// cross no line between two voxels, so only this test finds them.
/// @param complex  the complex of the solid's voxels and extra cells.
[[nodiscard]] Importance separation_angles(const GovernorField& governors, const CellComplex& complex,
                                           const NoiseFloor& floor, const Context& context);

}  // namespace blum::detail
