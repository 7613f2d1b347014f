// Blum: meshes as models of glTF. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/io/gltf_io.hpp"
#include "io/gltf/gltf_library.hpp"

namespace blum::gltf_files {

/// Largest size of a .glb file in bytes. Its length is a number of 32 bits.
inline constexpr std::uint64_t most_bytes = 0xffffffff;

/// Returns the model of a mesh.
/// @throws InvalidMesh, InvalidOption, FileError as write_gltf() does.
[[nodiscard]] gltf_library::Model model_of(const GltfMesh& mesh, const Context& context);

using TextureCorners = std::array<std::array<float, 2>, 3>;

/// Vertices of triangles, one copy for each texture position of their corners.
struct SplitVertices {
  std::vector<std::uint32_t> source;              ///< vertex of which each is a copy
  std::vector<std::array<float, 2>> coordinates;  ///< position of each in the texture
  std::vector<Triangle> triangles;                ///< corners, as indices of the copies
};

/// Returns the vertices in the order in which the triangles name them. Cost: linear.
[[nodiscard]] SplitVertices split_vertices(std::span<const Triangle> triangles,
                                           std::span<const TextureCorners> coordinates);

}  // namespace blum::gltf_files
