// Blum: the content of files, by their names and first bytes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/io/formats.hpp"
#include "blum/io/image_io.hpp"
#include "blum/io/mesh_io.hpp"

namespace blum {

/// Returns the kind of content of a file. The extension of the file decides, or the first bytes if the extension is
/// unknown. An .nrrd file is a field if it states that Blum wrote it as a field, else an image. An .npz file is a field
/// unless it is a complex (see holds_complex()). Files of .ply and .obj are meshes. If the path names a pipe, the
/// function reads the pipe and stores its bytes. The next function that reads the whole file gets the stored bytes.
/// @throws FileError if the file cannot be opened, is a directory or has no known content.
[[nodiscard]] FileContent content_of(const std::filesystem::path& path);

/// Returns true if a file holds a medial axis or another complex. The result is true for every .vtp and .ma file, and
/// for an .npz file with vertices and without distances. For a .ply file, the result is true only if the file states
/// that it is a medial axis, a Voronoi diagram or a centreline. For an .obj file, the result is false, because .obj
/// files cannot state their content.
/// @throws FileError if the file cannot be opened or is a directory.
[[nodiscard]] bool holds_complex(const std::filesystem::path& path);

/// Returns true if a file may be a field: it is a field written by Blum, or an .nrrd file of floating-point numbers.
/// The numbers in an .nrrd file of another program may be distances.
/// @throws FileError in the same cases as content_of().
[[nodiscard]] bool may_hold_field(const std::filesystem::path& path);

/// Read a mesh or an image. If the extension is unknown, the first bytes of the file decide the format.
/// @throws as read_mesh(), read_image().
[[nodiscard]] MeshFile read_mesh_of_any_name(const std::filesystem::path& path, const MeshReadOptions& options = {});
[[nodiscard]] ImageFile read_image_of_any_name(const std::filesystem::path& path);

/// Returns the name of an image's format: "NRRD", "NIfTI", "NPY", "Vol", or "unknown". The function opens the file, so
/// it must not be called for a pipe that was already read. For an image that was read, use ImageFile::format.
[[nodiscard]] std::string_view image_format_name(const std::filesystem::path& path);

/// Returns the paths of all files of a field that is written to a path. If the path is NAME.nrrd, the sites are in
/// NAME.site.nrrd. For order 2, the second distances and sites are in NAME.distance2.nrrd and NAME.site2.nrrd.
/// @param with_sites  true if the field has sites.
[[nodiscard]] std::vector<std::filesystem::path> files_of_field(const std::filesystem::path& path,
                                                                bool with_sites = true, int order = 1);

/// Returns the file that write_field() removes when it writes a field without sites to a path. The removed file is the
/// separate file with the sites of the replaced field. Returns nullopt if this file does not exist.
[[nodiscard]] std::optional<std::filesystem::path> sites_of_replaced_field(const std::filesystem::path& path);
/// Returns the files that write_field() removes when it writes a field of order 1 to a path. The removed files hold the
/// second distances and second sites of the replaced field.
[[nodiscard]] std::vector<std::filesystem::path> second_of_replaced_field(const std::filesystem::path& path);

}  // namespace blum
