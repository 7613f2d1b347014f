// Blum: recognition of binary STL. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "blum/io/formats.hpp"

namespace blum::volume_io {

/// Returns true if a file is a binary STL file with at least one triangle, by its first bytes and its size in bytes.
/// The size is 84, and 50 for each triangle that the header counts.
[[nodiscard]] bool is_binary_stl(std::string_view head, std::uint64_t size);

}  // namespace blum::volume_io

namespace blum {

/// Returns the format of a mesh whose extension is not known, by its first bytes and its size. A pipe is kept, as by
/// read_file_head(). @throws as read_whole_file().
[[nodiscard]] std::optional<MeshFormat> mesh_format_by_content(const std::filesystem::path& path,
                                                               std::string_view head);

}  // namespace blum
