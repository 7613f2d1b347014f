// Blum: the surface of a heap of boxes as a manifold. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/grid/voxel_set.hpp"

namespace blum {

/// Where a vertex may be, in voxels; without extent along an axis that it may not leave.
struct NetBox {
  Vec3d low, high;
};

/// The surface between a set of voxels and the rest as a closed, oriented manifold of quadrilaterals and triangles that
/// face the rest. Coordinates are in voxels: integer where voxels have their centres. Positions are those of the
/// surface of the boxes, but for a little room where boxes touch only in an edge or a corner, which are joined there.
struct SurfaceNet {
  static constexpr std::uint32_t none = 0xffffffff;

  std::vector<Vec3d> positions;
  std::vector<NetBox> boxes;                           ///< of each vertex: its position is inside
  std::vector<std::array<std::uint32_t, 4>> polygons;  ///< triangles end with none
};

/// @throws InvalidOption for more than max_id_count vertices or triangles; Cancelled.
[[nodiscard]] SurfaceNet make_surface_net(const VoxelSet& voxels, const Context& context);

}  // namespace blum
