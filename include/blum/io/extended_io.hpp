// Blum: files of extended medial axes (VTP, PLY, OBJ, NPZ, STL). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "blum/axis/extend_axis.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/io/medial_io.hpp"

namespace blum {

/// Writes an extended axis; the format goes by the extension. .vtp, .ply and .npz hold all of it with its columns and
/// what the metadata tell of the axis, besides `content` ("extended medial axis"), as write_complex() says, which
/// read_complex() reads; .obj the triangles and curves; .stl the triangles, in single precision. Columns that a format
/// cannot hold are left out.
///
/// A file appears under its name only when it is complete.
/// @throws InvalidOption for another extension, and for .stl where there are no triangles; FileError; Cancelled.
void write_extended(const std::filesystem::path& path, const Complex& surface, const MedialMetadata& metadata = {},
                    const Context& context = {});

}  // namespace blum
