// Blum: names, kinds and checks of input and output files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "blum/io/file_content.hpp"
#include "blum/io/formats.hpp"

namespace blum::cli {

enum class InputKind { mesh, image, field };

/// Returns the kind of a file's content, see content_of(). @throws FileError also for a medial axis.
[[nodiscard]] InputKind input_kind(const std::filesystem::path& path);

/// Rejects files that cannot contain a field, see may_hold_field(). @throws FileError, also as input_kind() does.
void check_may_be_field(const std::filesystem::path& path);

/// Returns the extensions of several contents for help texts: "Mesh (.obj .off .stl .ply) or image (.nrrd .npy)".
[[nodiscard]] std::string extensions_help(const std::vector<FileContent>& contents, FileAccess access);

/// Returns short names of files: as many last parts of their paths as distinguish different paths.
[[nodiscard]] std::vector<std::string> distinct_names(const std::vector<std::string>& files);

/// Returns the file name for one label: OUT-label3.nrrd for OUT.nrrd.
[[nodiscard]] std::filesystem::path with_label(const std::filesystem::path& path, std::int64_t label);

/// Rejects outputs that cannot be written, before any work is done.
/// @throws UsageError if an output is an input, or two outputs are one file.
/// @throws FileError if the folder does not exist or is not writable, or the name is that of a folder.
void check_outputs(const std::vector<std::filesystem::path>& outputs, const std::vector<std::filesystem::path>& inputs);

/// @throws UsageError with the name `option` if the extension is not one of `known`.
void check_extension(std::string_view option, const std::filesystem::path& path, const std::vector<std::string>& known);

/// Returns the bytes that this process can still allocate, as the system reports them. Infinity if it reports none.
[[nodiscard]] double available_memory();

/// Rejects work that needs more memory than is available, before the system ends the process half way.
/// @throws OutOfMemory with the memory that `what` needs, the available memory, and `advice` on what to do.
void check_memory(double bytes, std::string_view what, std::string_view advice);

}  // namespace blum::cli
