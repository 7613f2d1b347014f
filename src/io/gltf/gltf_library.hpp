// Blum: tinygltf, as Blum uses it. SPDX-License-Identifier: Apache-2.0
#pragma once

// Renames tinygltf's namespace in Blum's library, because programs that use Blum may contain another copy of tinygltf.
#define tinygltf blum_tinygltf
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

namespace blum {
namespace gltf_library = ::blum_tinygltf;
}  // namespace blum
