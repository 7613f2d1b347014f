// Blum: how many boxes, triangles or clusters a block holds. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace blum {

/// Width of the blocks that trees are made of: one cache line of doubles. Loops over them are in lane_kernels.cpp.
inline constexpr std::size_t lanes = 8;

}  // namespace blum
