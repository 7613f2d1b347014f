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

/// What a file holds, see content_of(). @throws FileError also for a medial axis.
[[nodiscard]] InputKind input_kind(const std::filesystem::path& path);

/// Refuses what cannot be a field, see may_hold_field(). @throws FileError, also as input_kind.
void check_may_be_field(const std::filesystem::path& path);

/// The extensions of several contents, for help texts: "Mesh (.obj .off .stl .ply) or image (.nrrd .npy)".
[[nodiscard]] std::string extensions_help(const std::vector<FileContent>& contents, FileAccess access);

/// OUT-label3.nrrd for OUT.nrrd.
[[nodiscard]] std::filesystem::path with_label(const std::filesystem::path& path, std::int64_t label);

/// Refuses, before any work is done, outputs that cannot work out.
/// @throws UsageError when an output is an input, or two outputs are one file; FileError when the folder is not there
/// or may not be written, or the name is a folder's.
void check_outputs(const std::vector<std::filesystem::path>& outputs, const std::vector<std::filesystem::path>& inputs);

/// @throws UsageError naming `option` unless the extension is one of `known`.
void check_extension(std::string_view option, const std::filesystem::path& path, const std::vector<std::string>& known);

/// Bytes that this process may still take, as far as the system says.
[[nodiscard]] double available_memory();

/// Refuses work that needs more memory than there is, instead of being killed half way.
/// @throws OutOfMemory saying how much `what` needs and how much there is; `advice` says what to do.
void check_memory(double bytes, std::string_view what, std::string_view advice);

}  // namespace blum::cli
