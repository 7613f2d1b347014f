// Implementation of tinygltf, which is header-only.
#define TINYGLTF_IMPLEMENTATION
#include "io/gltf/gltf_library.hpp"
