// Blum: names, kinds and checks of input and output files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "blum/grid/voxel_image.hpp"
#include "blum/io/mesh_io.hpp"

namespace blum::cli {

/// The last extension in lower case, with its dot; ".nii.gz", ".hdr.gz" and ".img.gz" count as one.
[[nodiscard]] std::string extension(const std::filesystem::path& path);

enum class InputKind { mesh, image, field };

/// What a file holds: by its extension, or by its first bytes where the extension is not known. An .nrrd file counts as
/// a field when it says that it is one of Blum's.
/// @throws FileError when the file cannot be opened, is a directory or is of no known kind.
[[nodiscard]] InputKind input_kind(const std::filesystem::path& path);

/// Whether a file holds a medial axis rather than a field, a mesh or anything else: every .vtp and .ma, an .npz with
/// vertices and no distances, a .ply that says so. An .obj does not tell.
/// @throws FileError when the file cannot be opened or is a directory.
[[nodiscard]] bool is_axis(const std::filesystem::path& path);

/// Refuses what cannot be a field: meshes, and images other than NRRD files of floating-point numbers, which may be
/// distances that another program wrote.
/// @throws FileError, also as input_kind.
void check_may_be_field(const std::filesystem::path& path);

/// Reads a mesh or an image, also one whose extension does not tell its format. @throws as read_mesh, read_image.
[[nodiscard]] MeshFile load_mesh(const std::filesystem::path& path, const MeshReadOptions& options);
[[nodiscard]] VoxelImage load_image(const std::filesystem::path& path);
/// "NRRD", "NIfTI", "NPY" or "Vol".
[[nodiscard]] std::string image_format_name(const std::filesystem::path& path);

/// Where a field goes: its name for read_field and write_field, and every file that stands for it (.nrrd makes two).
[[nodiscard]] std::vector<std::filesystem::path> field_files(const std::filesystem::path& path);

/// OUT-label3.nrrd for OUT.nrrd.
[[nodiscard]] std::filesystem::path with_label(const std::filesystem::path& path, std::int64_t label);

/// Refuses, before any work is done, outputs that cannot work out.
/// @throws UsageError when an output is an input, or two outputs are one file; FileError when the folder is not there
/// or may not be written, or the name is a folder's.
void check_outputs(const std::vector<std::filesystem::path>& outputs, const std::vector<std::filesystem::path>& inputs);

/// Makes an empty file beside another one, for what is not to bear that name yet: hidden, with the same extension, and
/// with a name that no file had. A link is followed, so that the file can take the place of what it points to.
/// @throws FileError
[[nodiscard]] std::filesystem::path make_draft(const std::filesystem::path& path);

/// Lets a draft take the place of a file, whose permissions it gets where there is one.
/// @throws FileError
void replace_by_draft(const std::filesystem::path& path, const std::filesystem::path& draft);

/// @throws UsageError naming `option` unless the extension is one of `known`.
void check_extension(std::string_view option, const std::filesystem::path& path, const std::vector<std::string>& known);

/// Refuses work that needs more memory than there is, instead of being killed half way.
/// @throws OutOfMemory saying how much `what` needs and how much there is; `advice` says what to do.
void check_memory(double bytes, std::string_view what, std::string_view advice);

}  // namespace blum::cli
