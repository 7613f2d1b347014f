// Blum: files of points with columns. SPDX-License-Identifier: Apache-2.0
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

/// Returns the extensions of files that read_points() reads and that hold points, not meshes.
[[nodiscard]] std::vector<std::string> cloud_extensions();

/// Reads points. The extension selects the format.
///
///   `.npy`  An array [n, 3] of numbers.
///   `.npz`  The array `points` [n, 3] or, if it is missing, `vertices` [n, 3].
///   `.csv`, `.xyz`, `.txt`  A row for each point. The first three numbers of a row are the coordinates, separated by
///                           commas, semicolons or blanks; the rest of the row is ignored. Empty rows, rows that begin
///                           with `#`, and a first row of names are ignored, too.
///   `.ply`, `.vtp`, `.obj`, `.off`, `.stl`  The vertices of the mesh or complex, in their order.
///
/// @throws FileError.
/// @throws FormatError with the file, the line and the reason, also for numbers that are not finite.
/// @throws InvalidOption for another extension.
/// @throws OutOfMemory.
[[nodiscard]] std::vector<Vec3d> read_points(const std::filesystem::path& path);

/// Reads the rows of a .csv, .xyz or .txt file from memory.
/// @param name  used as the name of the file in messages.
[[nodiscard]] std::vector<Vec3d> read_point_rows(std::span<const std::byte> text, const std::string& name = "points");

/// Writes points with their columns. The extension selects the format.
///
///   `.ply`, `.vtp`  As write_complex() does.
///   `.npz`          An array `points` [n, 3], one array for each column under its name, and `metadata`, a JSON object.
///   `.csv`          A row of names: x, y, z, then the names of the columns. The row of names is followed by a row for
///                   each point. A column of three numbers has the names NAME_x, NAME_y, NAME_z. A column of two, or
///                   more than three, numbers has NAME_0, NAME_1, ... CSV files have no metadata.
///
/// Numbers in text are exact.
/// @param metadata  if the key `content` is missing, it is added with the text "points". Functions that read axes and
///                  fields reject files whose `content` is "points".
/// @param points    a complex of vertices alone; validate(points) must pass.
/// @throws InvalidMesh, also if `points` has edges or triangles.
/// @throws InvalidOption for another extension, and in .npz for a column with the name `points` or `metadata`.
/// @throws FileError, Cancelled.
void write_points(const std::filesystem::path& path, const Complex& points, const FileMetadata& metadata = {},
                  const Context& context = {});

}  // namespace blum
