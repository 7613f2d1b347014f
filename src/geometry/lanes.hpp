// Blum: number of boxes, triangles or clusters per block. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace blum {

/// Number of items per block in search trees; as doubles they fill one cache line. Loops over blocks are in
/// lane_kernels.cpp.
inline constexpr std::size_t lanes = 8;

}  // namespace blum
