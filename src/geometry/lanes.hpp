// Blum: number of boxes, triangles or clusters per block. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace blum {

/// Width of the blocks of search trees: one cache line of doubles. Loops over blocks are in lane_kernels.cpp.
inline constexpr std::size_t lanes = 8;

}  // namespace blum
