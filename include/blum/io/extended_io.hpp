// Blum: files of extended medial axes (VTP, PLY, OBJ, NPZ, STL). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "blum/axis/extend_axis.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/io/medial_io.hpp"

namespace blum {

/// Writes an extended axis. The extension selects the format. Files of .vtp, .ply and .npz hold the whole axis and its
/// columns (see write_complex()); read_complex() reads them. Their metadata are `content` ("extended medial axis") and,
/// if known, `blum_version`, `source`, `theta`, `lambda`, `spacing`, `deviation`, `smooth`. Files of .obj hold the
/// triangles and curves. Files of .stl hold the triangles, in single precision. Columns that a format cannot hold are
/// left out.
///
/// A file appears under its name only when it is complete.
/// @throws InvalidOption for another extension, and for .stl without triangles.
/// @throws FileError, Cancelled.
void write_extended(const std::filesystem::path& path, const Complex& surface, const MedialMetadata& metadata = {},
                    const Context& context = {});

}  // namespace blum
