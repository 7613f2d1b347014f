// Blum: the coordinates in which fields are computed. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/grid_spec.hpp"

namespace blum::cpu {

/// Maps the world so that float32 loses nothing: the grid's axes become x, y, z, the box around mesh and grid is
/// centred on the origin, and its diagonal lies in (1/2, 1]. The scale is a power of two, so that it is exact.
struct NormalFrame {
  Mat3 direction;
  Vec3d center;      ///< of the common box, in grid axes
  double scale = 1;  ///< normalised = world * scale
  Vec3d first_node;  ///< normalised position of node (0, 0, 0)
  Vec3d spacing;     ///< normalised

  [[nodiscard]] Vec3d to_normal(const Vec3d& world) const {
    return (direction.transposed_times(world) - center) * scale;
  }
};

/// @param named  the vertices that the mesh names.
/// @throws InvalidGrid when the common box is so large that float32 distances would overflow.
[[nodiscard]] NormalFrame make_normal_frame(const MeshView& mesh, std::span<const std::uint32_t> named,
                                            const GridSpec& grid);

}  // namespace blum::cpu
