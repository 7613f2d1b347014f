// Blum: the metadata of field files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "blum/field/field.hpp"
#include "blum/io/field_io.hpp"

namespace blum::volume_io {

/// Pairs of key and value in the order of the file. Values are text; numbers are in their shortest exact form.
using Metadata = std::vector<std::pair<std::string, std::string>>;

/// What site ids number, for people who read the file.
[[nodiscard]] std::string site_sentence(SiteIds ids);

[[nodiscard]] Metadata field_metadata(const Field& field, const FieldFileInfo& info);

/// Sets the band, sign rule and kind of site values of a field as its metadata say; unknown keys are left alone.
/// @throws FormatError with `name` when a known key has a value that it cannot have.
void apply_metadata(const Metadata& metadata, const std::string& name, Field& field);

/// The value of a key, or an empty view.
[[nodiscard]] std::string_view find_value(const Metadata& metadata, std::string_view key);

/// One JSON object whose values are all strings, in ASCII (other characters are escaped; bytes that are not UTF-8
/// become U+FFFD).
[[nodiscard]] std::string to_json(const Metadata& metadata);

/// Reads back what to_json writes. @throws FormatError with `name` for anything else.
[[nodiscard]] Metadata from_json(std::string_view json, const std::string& name);

}  // namespace blum::volume_io
