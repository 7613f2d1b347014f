// Blum: metadata as JSON. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "blum/io/file_metadata.hpp"

namespace blum::volume_io {

/// One JSON object whose values are all strings, in ASCII (other characters are escaped; bytes that are not UTF-8
/// become U+FFFD).
[[nodiscard]] std::string to_json(const FileMetadata& metadata);

/// The same where the values of some keys are numbers, true or false: those that read as such.
[[nodiscard]] std::string to_typed_json(const FileMetadata& metadata, std::span<const std::string_view> typed);

/// A text in quotes, as JSON has it; bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string json_text(const std::string& text);

/// The same text; bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string valid_utf8(const std::string& text);

/// Reads back what to_json writes. @throws FormatError with `name` for anything else.
[[nodiscard]] FileMetadata from_json(std::string_view text, const std::string& name);

}  // namespace blum::volume_io
