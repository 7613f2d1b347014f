// Blum: reading medial axes from bytes in tests. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <stdexcept>
#include <string>

#include "blum/core/error.hpp"
#include "blum/io/medial_io.hpp"

namespace blum::test {

inline MedialFile parse_medial(const std::string& content, ComplexFormat format) {
  return read_medial(std::as_bytes(std::span(content)), format, "test.axis");
}

/// The message with which the content is refused; "read" if it is accepted.
inline std::string medial_refusal(const std::string& content, ComplexFormat format) {
  try {
    (void)parse_medial(content, format);
  } catch (const FormatError& error) {
    return error.what();
  }
  return "read";
}

/// A text with the first `from` replaced. Throws if the text does not contain `from`.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::invalid_argument("there is no '" + from + "' to replace");
  return text.replace(at, from.size(), to);
}

}  // namespace blum::test
