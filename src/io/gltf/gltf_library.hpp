// Blum: tinygltf, as Blum uses it. SPDX-License-Identifier: Apache-2.0
#pragma once

// Blum's library contains tinygltf under another name, because programs that use Blum may contain another copy.
#define tinygltf blum_tinygltf
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

namespace blum {
namespace gltf_library = ::blum_tinygltf;
}  // namespace blum
