// Blum: spurs of curve graphs. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "blum/core/vec3.hpp"
#include "medial_axis/centreline/curve_graph.hpp"

namespace blum::centrelines {

/// What chains are judged by.
struct ChainMeasure {
  std::span<const float> depth;        ///< of each voxel of the box
  std::array<std::int64_t, 3> size{};  ///< of the box
  Vec3d spacing{};

  [[nodiscard]] Vec3d position(std::uint32_t voxel) const;
  /// Of the polyline through the voxels' centres.
  [[nodiscard]] double length(const std::vector<std::uint32_t>& voxels) const;
  [[nodiscard]] double voxel() const;  ///< the longest side of one
};

/// Takes away, until there is nothing more to do,
/// - spurs: branches with a free end that lie within `spur` radii of the ball at their root, and a voxel and a half
/// more;
///   where no other branch is at the root, the two longest stay;
/// - forks at the tip of a part, as corners make them: all branches of a junction, or all but one, have free ends, and
///   no tip lies further beyond the ball at the root than 3/4 of its radius and a voxel;
/// - branches between junctions of which each lies in the ball of the other: they become one;
/// - branches with two free ends, neither of which lies further beyond the largest ball on them: they become a point;
/// and joins the two branches at nodes that are left with two. All of this keeps the homotopy type.
void prune_spurs(CurveGraph& graph, const ChainMeasure& measure, double spur, const Context& context);

}  // namespace blum::centrelines
