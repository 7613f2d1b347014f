// Blum: files of points with attributes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/vec3.hpp"
#include "blum/io/file_metadata.hpp"

namespace blum {

/// Those of the extensions which read_points() reads whose files hold points, and no mesh.
[[nodiscard]] std::vector<std::string> cloud_extensions();

/// Reads points, by the extension:
///
///   .npy        an array [n, 3] of numbers
///   .npz        the array `points`, else `vertices`, [n, 3]
///   .csv .xyz .txt   a row for each point, whose first three numbers, parted by commas, semicolons or blanks, are its
///               coordinates; what follows is passed over, so are empty rows, those that begin with `#`, and a first
///               row of names
///   .ply .vtp .obj .off .stl   the vertices, in their order
///
/// @throws FileError; FormatError naming the file, the line and the reason, also for what is not finite; InvalidOption
/// for another extension; OutOfMemory.
[[nodiscard]] std::vector<Vec3d> read_points(const std::filesystem::path& path);

/// The rows of a .csv, .xyz or .txt file from memory. @param name  what stands for the file in messages.
[[nodiscard]] std::vector<Vec3d> read_point_rows(std::span<const std::byte> text, const std::string& name = "points");

/// Writes points with their columns: .ply, .vtp as write_complex() does; .npz as an array `points` [n, 3], one for each
/// column under its name, and `metadata`, a JSON object; .csv with a first row of names: x, y, z, then the columns;
/// those of three numbers are NAME_x, NAME_y, NAME_z, others of several NAME_0, NAME_1, ... CSV files have no metadata.
/// Numbers of text are exact.
/// @param metadata  `content` is "points" where it does not say otherwise: readers of axes and fields refuse such
/// files.
/// @param points  a complex of vertices alone; validate(points) must pass.
/// @throws InvalidMesh, InvalidOption for another extension, FileError, Cancelled.
void write_points(const std::filesystem::path& path, const Complex& points, const FileMetadata& metadata = {},
                  const Context& context = {});

}  // namespace blum
