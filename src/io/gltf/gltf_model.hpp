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

/// Largest size of a .glb file in bytes. The file states its length as a 32-bit number.
inline constexpr std::uint64_t most_bytes = 0xffffffff;

/// Returns the model of a mesh.
/// @throws InvalidMesh, InvalidOption, FileError as for write_gltf().
[[nodiscard]] gltf_library::Model model_of(const GltfMesh& mesh, const Context& context);

using TextureCorners = std::array<std::array<float, 2>, 3>;

/// Vertices split at texture seams: one copy of a vertex for each texture position of its corners.
struct SplitVertices {
  std::vector<std::uint32_t> source;              ///< for each copy: the vertex it was made from
  std::vector<std::array<float, 2>> coordinates;  ///< for each copy: its position in the texture
  std::vector<Triangle> triangles;                ///< corners are indices of copies
};

/// Returns the copies in the order in which the triangles use them. Cost: linear.
[[nodiscard]] SplitVertices split_vertices(std::span<const Triangle> triangles,
                                           std::span<const TextureCorners> coordinates);

}  // namespace blum::gltf_files
