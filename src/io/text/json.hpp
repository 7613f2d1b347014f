// Blum: metadata as JSON. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "blum/io/file_metadata.hpp"

namespace blum::volume_io {

/// Returns a JSON object whose values are all strings. The text is ASCII: other characters are escaped, and bytes that
/// are not UTF-8 become U+FFFD.
[[nodiscard]] std::string to_json(const FileMetadata& metadata);

/// Returns the same object, except for the keys `typed`. Their values are written without quotes if they are valid
/// JSON, for example numbers, true or false.
[[nodiscard]] std::string to_typed_json(const FileMetadata& metadata, std::span<const std::string_view> typed);

/// Returns a text in quotes, as a JSON string. Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string json_text(const std::string& text);

/// Returns a text in which bytes that are not UTF-8 are replaced by U+FFFD.
[[nodiscard]] std::string valid_utf8(const std::string& text);

/// Parses text that to_json() wrote. @throws FormatError with `name` for any other text.
[[nodiscard]] FileMetadata from_json(std::string_view text, const std::string& name);

}  // namespace blum::volume_io
