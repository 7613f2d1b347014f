// Blum: methods that find the sides of points. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace blum::sign {

enum class Method : std::uint8_t {
  none,          ///< Distances are unsigned.
  crossings,     ///< Whole winding numbers: every edge is traversed equally often in both directions.
  sums,          ///< Generalized winding numbers of a surface with a boundary.
  pseudonormals  ///< Side of the closest site, decided by its pseudonormal.
};

/// Returns true if a method uses winding numbers.
[[nodiscard]] constexpr bool is_by_winding(Method method) {
  return method == Method::crossings || method == Method::sums;
}

}  // namespace blum::sign
