// The code of tinygltf, which is all in its header.
#define TINYGLTF_IMPLEMENTATION
#include "io/gltf/gltf_library.hpp"
