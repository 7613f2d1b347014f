// Blum: how the sides of points are found. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace blum::sign {

enum class Method : std::uint8_t {
  none,          ///< unsigned
  crossings,     ///< winding numbers, which are whole: every edge is run along equally often both ways
  sums,          ///< generalized winding numbers of a surface with a boundary
  pseudonormals  ///< the side of the closest site that its normal tells
};

/// Whether a method goes by winding numbers.
[[nodiscard]] constexpr bool is_by_winding(Method method) {
  return method == Method::crossings || method == Method::sums;
}

}  // namespace blum::sign
