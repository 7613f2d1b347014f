// Blum: vertices with one place in a texture each. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/geometry/triangle_mesh.hpp"

namespace blum::gltf_files {

using TextureCorners = std::array<std::array<float, 2>, 3>;

/// The vertices of triangles, once for each place in the texture that their corners have.
struct SplitVertices {
  std::vector<std::uint32_t> source;              ///< which vertex each was
  std::vector<std::array<float, 2>> coordinates;  ///< where it is in the texture
  std::vector<Triangle> triangles;                ///< their corners among these
};

/// In the order in which the triangles name them. Cost: linear.
[[nodiscard]] SplitVertices split_vertices(std::span<const Triangle> triangles,
                                           std::span<const TextureCorners> coordinates);

}  // namespace blum::gltf_files
