// Blum: counted words in messages. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "blum/core/exact_text.hpp"

namespace blum {

/// Returns a count with its noun: "1 edge", "2 edges".
inline std::string plural(std::uint64_t count, std::string_view one, std::string_view many) {
  return count_text(count) + " " + std::string(count == 1 ? one : many);
}

}  // namespace blum
