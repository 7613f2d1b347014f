// Blum: bits of numbers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace blum {

/// The number of bits that are set. std::popcount() is a call of a function where the instruction for it is not known
/// to be there when this is compiled, which counts in loops.
[[nodiscard]] constexpr std::uint32_t bit_count(std::uint64_t bits) {
  bits -= bits >> 1U & 0x5555555555555555ULL;
  bits = (bits & 0x3333333333333333ULL) + (bits >> 2U & 0x3333333333333333ULL);
  bits = (bits + (bits >> 4U)) & 0x0f0f0f0f0f0f0f0fULL;
  return static_cast<std::uint32_t>((bits * 0x0101010101010101ULL) >> 56U);
}

}  // namespace blum
