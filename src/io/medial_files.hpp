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

/// Writes positions, the column `radius` of the vertices (float64), edges and triangles; nothing else.
void write_ma(const std::filesystem::path& path, const Complex& complex, const Context& context);
/// @throws FormatError. problem_of_medial() is to be asked afterwards.
[[nodiscard]] Complex read_ma(std::string_view text, std::string_view name);

[[nodiscard]] FileMetadata to_pairs(const MedialMetadata& metadata);
/// @throws FormatError with `name` when a known key has a value that it cannot have.
[[nodiscard]] MedialMetadata from_pairs(const FileMetadata& pairs, const std::string& name);

}  // namespace blum::medial_files
