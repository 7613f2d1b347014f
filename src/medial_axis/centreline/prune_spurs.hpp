// Blum: pruning of spurs of curve graphs. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "blum/core/vec3.hpp"
#include "medial_axis/centreline/curve_graph.hpp"

namespace blum::centrelines {

/// Depths and sizes of the voxels of a box, from which the lengths and balls of chains are computed.
struct ChainMeasure {
  std::span<const float> depth;        ///< for each voxel of the box
  std::array<std::int64_t, 3> size{};  ///< number of voxels of the box along each axis
  Vec3d spacing{};

  [[nodiscard]] Vec3d position(std::uint32_t voxel) const;
  /// Returns the length of the polyline through the voxels' centres.
  [[nodiscard]] double length(const std::vector<std::uint32_t>& voxels) const;
  [[nodiscard]] double voxel() const;  ///< longest side of a voxel
};

/// Simplifies a graph until nothing changes. Each step keeps the homotopy type.
///
/// The ball of a node has the depth of its voxel as radius. Spurs are removed: branches with a free end, all of whose
/// voxels are near the node at the other end, the root. Near means: not further than `spur` radii of the root's ball
/// plus 1.5 voxels. If all branches of the root are spurs, the two longest stay.
///
/// Forks at the tip of a part are removed, because they only show its corners. In a fork, all branches of a junction,
/// or all but one, have free ends. None of their tips is further outside the ball of the junction than 3/4 of its
/// radius plus one voxel.
///
/// Two junctions become one if each lies in the ball of the other, with a tolerance of one voxel: the branch between
/// them is contracted.
///
/// A branch with two free ends becomes a point if both tips are near the largest ball on the branch. Near means:
/// outside the ball by at most 3/4 of its radius plus one voxel.
///
/// If exactly two branches are left at a node, they are joined to one.
void prune_spurs(CurveGraph& graph, const ChainMeasure& measure, double spur, const Context& context);

}  // namespace blum::centrelines
