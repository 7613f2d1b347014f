// The code of tinygltf, which is all in its header.
#define TINYGLTF_IMPLEMENTATION
#include "io/gltf_library.hpp"
