// Blum: pruning of spurs of curve graphs. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "blum/core/vec3.hpp"
#include "medial_axis/centreline/curve_graph.hpp"

namespace blum::centrelines {

/// Measures by which chains are judged.
struct ChainMeasure {
  std::span<const float> depth;        ///< of each voxel of the box
  std::array<std::int64_t, 3> size{};  ///< of the box
  Vec3d spacing{};

  [[nodiscard]] Vec3d position(std::uint32_t voxel) const;
  /// Returns the length of the polyline through the voxels' centres.
  [[nodiscard]] double length(const std::vector<std::uint32_t>& voxels) const;
  [[nodiscard]] double voxel() const;  ///< longest side of a voxel
};

/// Simplifies a graph until nothing changes. Each step keeps the homotopy type.
///
/// Spurs are removed: branches with a free end within `spur` radii of the ball at their root, and a voxel and a half
/// more. If no other branch is at the root, the two longest stay.
///
/// Forks at the tip of a part, as corners make them, are removed. All branches of a junction, or all but one, have free
/// ends. No tip lies further beyond the ball at the root than 3/4 of its radius and a voxel.
///
/// Junctions become one if each lies in the ball of the other: the branch between them is contracted.
///
/// A branch with two free ends becomes a point if neither end lies further than that beyond the largest ball on it.
///
/// If a node is left with two branches, these are joined.
void prune_spurs(CurveGraph& graph, const ChainMeasure& measure, double spur, const Context& context);

}  // namespace blum::centrelines
