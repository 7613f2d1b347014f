// Blum: meshes as glTF has them. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "blum/io/gltf_io.hpp"
#include "io/gltf/gltf_library.hpp"

namespace blum::gltf_files {

/// The most bytes of a .glb file, whose length is a number of 32 bits.
inline constexpr std::uint64_t most_bytes = 0xffffffff;

/// @throws InvalidMesh, InvalidOption, FileError as write_gltf() says.
[[nodiscard]] gltf_library::Model model_of(const GltfMesh& mesh, const Context& context);

}  // namespace blum::gltf_files
