// Blum: reading a whole file into memory. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "blum/core/buffer.hpp"

namespace blum {

/// The content of a file.
struct FileBytes {
  Buffer<std::byte> storage = {};
  std::size_t size = 0;  ///< the storage may be larger
  [[nodiscard]] std::span<const std::byte> span() const { return storage.span().first(size); }
};

/// The bytes of a file, or of a pipe until it ends.
/// @throws FileError when it cannot be read or is a directory; OutOfMemory.
[[nodiscard]] FileBytes read_whole_file(const std::filesystem::path& path);

}  // namespace blum
