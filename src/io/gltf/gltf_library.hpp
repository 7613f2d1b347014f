// Blum: tinygltf, as Blum uses it. SPDX-License-Identifier: Apache-2.0
#pragma once

// It becomes a part of Blum's library, under a name of its own: programs that use Blum may have another one beside it.
#define tinygltf blum_tinygltf
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

namespace blum {
namespace gltf_library = ::blum_tinygltf;
}  // namespace blum
