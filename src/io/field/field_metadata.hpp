// Blum: the metadata of field files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "blum/field/field.hpp"
#include "blum/io/field_io.hpp"
#include "io/text/json.hpp"

namespace blum::volume_io {

/// Numbers are in their shortest exact form.
using Metadata = FileMetadata;

/// What site ids number, for people who read the file.
[[nodiscard]] std::string site_sentence(SiteIds ids);

[[nodiscard]] Metadata field_metadata(const Field& field, const FieldFileInfo& info);

/// Sets the band, sign rule and kind of site values of a field as its metadata say; unknown keys are left alone.
/// @throws FormatError with `name` when a known key has a value that it cannot have.
void apply_metadata(const Metadata& metadata, const std::string& name, Field& field);

}  // namespace blum::volume_io
