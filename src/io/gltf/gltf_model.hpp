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

/// The most bytes of a .glb file, whose length is a number of 32 bits.
inline constexpr std::uint64_t most_bytes = 0xffffffff;

/// @throws InvalidMesh, InvalidOption, FileError as write_gltf() says.
[[nodiscard]] gltf_library::Model model_of(const GltfMesh& mesh, const Context& context);

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
