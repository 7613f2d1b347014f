// Blum: numbers in messages. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace blum {

/// The shortest text that reads back as this number; std::to_string would print 300 digits of 1e300.
inline std::string exact_text(double value) {
  std::array<char, 32> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

}  // namespace blum
