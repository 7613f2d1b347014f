// Blum: check of angles in options. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"

namespace blum::detail {

/// Checks that an angle lies between 0 and 180 degrees, inclusive.
/// @param angle  degrees.
/// @throws InvalidOption if the angle is below 0 or above 180.
inline void check_angle(std::string_view name, double angle) {
  if (angle >= 0 && angle <= 180) return;
  throw InvalidOption(std::string(name) + " is " + exact_text(angle) + " degrees, but must be 0 to 180");
}

}  // namespace blum::detail
