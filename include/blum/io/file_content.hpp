// Blum: the content of files, by their names and first bytes. SPDX-License-Identifier: Apache-2.0
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

/// Returns the content of a file: by its extension or, if that is not known, by its first bytes. An .nrrd file is a
/// field if it states that Blum wrote it as one, else an image. An .npz file is a field unless it is a complex (see
/// holds_complex). .ply and .obj files are meshes.
/// @throws FileError if the file cannot be opened, is a directory or has no known content.
[[nodiscard]] FileContent content_of(const std::filesystem::path& path);

/// Returns true if a file holds a medial axis or another complex. It does so for every .vtp and .ma file, and for an
/// .npz file with vertices and no distances. A .ply file must state that it is a medial axis. For .obj files it returns
/// false, because they do not state it.
/// @throws FileError if the file cannot be opened or is a directory.
[[nodiscard]] bool holds_complex(const std::filesystem::path& path);

/// Returns true if a file may be a field: one of Blum's, or an .nrrd file of floating-point numbers. These may be
/// distances that another program wrote.
/// @throws FileError as content_of().
[[nodiscard]] bool may_hold_field(const std::filesystem::path& path);

/// Reads a mesh or an image, also from a file whose extension does not show its format.
/// @throws as read_mesh(), read_image().
[[nodiscard]] MeshFile read_mesh_of_any_name(const std::filesystem::path& path, const MeshReadOptions& options = {});
[[nodiscard]] VoxelImage read_image_of_any_name(const std::filesystem::path& path);

/// Returns "NRRD", "NIfTI", "NPY", "Vol", or "unknown".
[[nodiscard]] std::string_view image_format_name(const std::filesystem::path& path);

/// Returns every file of a field of this name. Beside NAME.nrrd, the sites are in NAME.site.nrrd. For order 2, the
/// second distances and sites are in NAME.distance2.nrrd and NAME.site2.nrrd.
/// @param with_sites  true if the field has sites.
[[nodiscard]] std::vector<std::filesystem::path> files_of_field(const std::filesystem::path& path,
                                                                bool with_sites = true, int order = 1);

/// Returns the file that write_field() removes when it writes a field without sites under this name. It is the separate
/// file with the sites of the replaced field, if one exists.
[[nodiscard]] std::optional<std::filesystem::path> sites_of_replaced_field(const std::filesystem::path& path);
/// Returns the files that it removes for a field of order 1: those of the second distances and sites of the replaced
/// field.
[[nodiscard]] std::vector<std::filesystem::path> second_of_replaced_field(const std::filesystem::path& path);

}  // namespace blum
