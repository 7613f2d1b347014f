// Blum: medial axes as the complexes, columns and metadata of files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/io/file_metadata.hpp"
#include "blum/io/medial_io.hpp"

namespace blum::medial_files {

/// Of MedialMetadata::smooth.
constexpr int most_smoothing = 1000;

[[nodiscard]] FileMetadata to_pairs(const MedialMetadata& metadata);
/// @throws FormatError with `name` when a known key has a value that it cannot have.
[[nodiscard]] MedialMetadata from_pairs(const FileMetadata& pairs, const std::string& name);

/// Which columns of a medial axis a complex had.
struct MedialColumns {
  bool radii = false, footprints = false, sites = false;
  bool angles = false;  ///< of vertices, edges and triangles
  bool labels = false;  ///< sheets and roles
};

// Both give those columns of MedialView (MedialLevels) that the complex of a file has their order and types, from any
// numeric type that may hold them; other columns follow. Both throw FormatError with `name` for a column that cannot be
// that of an axis.

/// Columns of vertices, edges or triangles that are missing stay so, but where there are none of these. Edges without
/// roles that are sides of triangles are left out.
[[nodiscard]] Complex to_axis(Complex complex, const std::string& name, MedialColumns& found);
/// All columns must be there.
[[nodiscard]] Complex to_nested(const Complex& complex, const std::string& name);

/// Edges that are sides of triangles go, as the triangles imply them.
[[nodiscard]] Complex without_sides(Complex complex);

}  // namespace blum::medial_files
