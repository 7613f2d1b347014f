// Blum: bits of numbers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace blum {

/// Returns the number of bits that are 1. Blum uses this function instead of std::popcount(). On targets that may lack
/// an instruction for counting bits, std::popcount() is a function call, which is slow in loops.
[[nodiscard]] constexpr std::uint32_t bit_count(std::uint64_t bits) {
  bits -= bits >> 1U & 0x5555555555555555ULL;
  bits = (bits & 0x3333333333333333ULL) + (bits >> 2U & 0x3333333333333333ULL);
  bits = (bits + (bits >> 4U)) & 0x0f0f0f0f0f0f0f0fULL;
  return static_cast<std::uint32_t>((bits * 0x0101010101010101ULL) >> 56U);
}

}  // namespace blum
