// Blum: loops over eight lanes, compiled for several instruction sets. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

/// Marks a function whose loops over `lanes` the compiler shall vectorise, once per instruction set; the right one is
/// picked when the program starts. Elsewhere, and under sanitizers (which cannot run before the program does), it
/// stands for nothing, and the baseline instructions are used.
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !defined(BLUM_NO_SIMD)
#define BLUM_LANE_LOOPS __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define BLUM_LANE_LOOPS
#endif

namespace blum {

/// Width of the blocks that trees are made of: one cache line of doubles.
inline constexpr std::size_t lanes = 8;

}  // namespace blum
