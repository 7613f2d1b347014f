// Blum: the formats of complexes, one by one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "blum/core/context.hpp"
#include "blum/io/complex_io.hpp"
#include "io/bytes/byte_source.hpp"

namespace blum::complex_files {

/// Refuses to write what a format cannot hold, unless the options allow the loss.
/// @param format  its name.  @param kept  the only column that it holds, of vertices; may be empty.
/// @throws InvalidOption naming what would be lost.
void refuse_loss(const std::filesystem::path& path, std::string_view format, const Complex& complex,
                 const FileMetadata& metadata, const ComplexWriteOptions& options, std::string_view kept = {});

// The writers get complexes without problems (problem_of), and names and metadata that files can hold.
void write_vtp(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata,
               const ComplexWriteOptions& options, const Context& context);
void write_ply(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata,
               const ComplexWriteOptions& options, const Context& context);
void write_obj(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata,
               const ComplexWriteOptions& options, const Context& context);
void write_npz(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata,
               const ComplexWriteOptions& options, const Context& context);
void write_glb(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata,
               const ComplexWriteOptions& options, const Context& context);

// The readers check whatever they need to be safe; problem_of is asked afterwards. All throw FormatError.
[[nodiscard]] ComplexFile read_vtp(const volume_io::ByteSource& source);
[[nodiscard]] ComplexFile read_npz(const volume_io::ByteSource& source);
[[nodiscard]] ComplexFile read_ply(std::string_view bytes, std::string_view name);
[[nodiscard]] ComplexFile read_obj(std::string_view text, std::string_view name);

}  // namespace blum::complex_files
