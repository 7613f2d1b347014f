// Blum: what files hold, by their names and first bytes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/grid/voxel_image.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/mesh_io.hpp"

namespace blum {

/// What a file holds: by its extension, or by its first bytes where the extension is not known. An .nrrd file is a
/// field when it says that it is one of Blum's, an .npz file unless it is a complex (see holds_complex), a .ply and an
/// .obj file a mesh.
/// @throws FileError when the file cannot be opened, is a directory or is of no known kind.
[[nodiscard]] FileContent content_of(const std::filesystem::path& path);

/// Whether a file holds a medial axis or another complex rather than a field, a mesh or anything else: every .vtp and
/// .ma, an .npz with vertices and no distances, a .ply that says that it is a medial axis. An .obj does not tell.
/// @throws FileError when the file cannot be opened or is a directory.
[[nodiscard]] bool holds_complex(const std::filesystem::path& path);

/// Whether a file may be a field: one of Blum's, or an .nrrd file of floating-point numbers, which may be distances
/// that another program wrote. @throws FileError, as content_of.
[[nodiscard]] bool may_hold_field(const std::filesystem::path& path);

/// Reads a mesh or an image, also one whose extension does not tell its format. @throws as read_mesh, read_image.
[[nodiscard]] MeshFile read_mesh_of_any_name(const std::filesystem::path& path, const MeshReadOptions& options = {});
[[nodiscard]] VoxelImage read_image_of_any_name(const std::filesystem::path& path);

/// "NRRD", "NIfTI", "NPY", "Vol", or "unknown".
[[nodiscard]] std::string_view image_format_name(const std::filesystem::path& path);

/// Every file that stands for a field of this name: for .nrrd, its sites are in a second one, NAME.site.nrrd, and of
/// order 2 the second distances and sites in NAME.distance2.nrrd and NAME.site2.nrrd.
/// @param with_sites  whether the field has any.
[[nodiscard]] std::vector<std::filesystem::path> files_of_field(const std::filesystem::path& path,
                                                                bool with_sites = true, int order = 1);

/// The file that write_field() removes when it writes a field without sites under this name: the sites of the field
/// that it replaces, where they are in a file of their own.
[[nodiscard]] std::optional<std::filesystem::path> sites_of_replaced_field(const std::filesystem::path& path);
/// The same for a field of order 1: the files of the second distances and sites of the field that it replaces.
[[nodiscard]] std::vector<std::filesystem::path> second_of_replaced_field(const std::filesystem::path& path);

}  // namespace blum
