// Blum: what reading and writing medial axes is made of. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/io/file_metadata.hpp"
#include "blum/io/medial_io.hpp"

namespace blum::medial_files {

/// Of MedialMetadata::smooth.
constexpr int most_smoothing = 1000;

[[nodiscard]] FileMetadata to_pairs(const MedialMetadata& metadata);
/// @throws FormatError with `name` when a known key has a value that it cannot have.
[[nodiscard]] MedialMetadata from_pairs(const FileMetadata& pairs, const std::string& name);

}  // namespace blum::medial_files
