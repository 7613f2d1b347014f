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

/// Returns the kind of a file's content, as content_of() does. @throws FileError, also if the file is a medial axis.
[[nodiscard]] InputKind input_kind(const std::filesystem::path& path);

/// Rejects files that cannot contain a field, by may_hold_field(). @throws FileError, also in the cases of
/// input_kind().
void check_may_be_field(const std::filesystem::path& path);

/// Returns the extensions of several kinds of content, for help texts: "Mesh (.obj .off .stl .ply) or image (.nrrd
/// .npy)".
[[nodiscard]] std::string extensions_help(const std::vector<FileContent>& contents, FileAccess access);

/// Returns short names of files: the last components of their paths. Names of different paths differ.
[[nodiscard]] std::vector<std::string> distinct_names(const std::vector<std::string>& files);

/// Returns the name of the output file for one label: OUT-label3.nrrd for OUT.nrrd.
[[nodiscard]] std::filesystem::path with_label(const std::filesystem::path& path, std::int64_t label);

/// Throws if an output cannot be written, so that the error comes before any work.
/// @throws UsageError if an output is also an input, or if two outputs are the same file.
/// @throws FileError if an output's folder does not exist or is not writable, or if the output is a folder.
void check_outputs(const std::vector<std::filesystem::path>& outputs, const std::vector<std::filesystem::path>& inputs);

/// @throws UsageError, with the name `option`, if the extension is not one of `known`.
void check_extension(std::string_view option, const std::filesystem::path& path, const std::vector<std::string>& known);

/// Returns the number of bytes that this process can still allocate, as reported by the system; infinity if it is not
/// reported.
[[nodiscard]] double available_memory();

/// Throws if work needs more memory than is available. Otherwise the system might end the process during the work.
/// @throws OutOfMemory. The message states the memory that `what` needs, the available memory, and `advice`.
void check_memory(double bytes, std::string_view what, std::string_view advice);

}  // namespace blum::cli
