// Blum: recognition of binary STL. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace blum::volume_io {

/// Returns true if a file is a binary STL file with at least one triangle, by its first bytes and its size in bytes.
/// The size is 84, and 50 for each triangle that the header counts.
[[nodiscard]] bool is_binary_stl(std::string_view head, std::uint64_t size);

}  // namespace blum::volume_io
