// Blum: field files (NRRD, NPZ, VTI). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/io/formats.hpp"

namespace blum {

/// Further content of a field file. Everything is optional; nothing is copied or owned.
struct FieldFileInfo {
  /// Mesh of the field. .npz files get its vertices and the vertices of its sites.
  const MeshView* mesh = nullptr;
  /// Sites of that mesh. If they are missing, they are computed from `mesh` where needed.
  const SiteTable* sites = nullptr;
  /// Source of the shape, for example a file name.
  std::string source = {};
  /// Version of Blum.
  std::string version = {};
  /// Meaning of the world axes, as NRRD names it: VoxelImage::space of the field's image. NRRD files get it as their
  /// `space`, other formats in their metadata. NRRD files omit a name that NRRD does not know.
  std::string space = {};
};

/// Writes a field. The extension selects the format. In all formats, distances are float32 in mesh units (negative
/// inside when signed). Sites are int32 (-1 if none). There is one per node, x fastest.
///
///   `.nrrd`  The distances, raw. The sites go to a second file, OUT.site.nrrd for OUT.nrrd. The second distances and
///            sites of a field of order 2 go to OUT.distance2.nrrd and OUT.site2.nrrd. Metadata are key/value pairs.
///   `.npz`   Uncompressed arrays for NumPy: `distance` and `site`, for order 2 also `distance2` and `site2`, [z, y,
///            x]. `origin` and `spacing` are float64 [3] in x, y, z order. `direction` is float64 [3, 3]; column a is
///            the direction of index axis a. `metadata` is one string of JSON. With a mesh and mesh sites also
///            `vertices` float64 [m, 3] and `site_vertices` int32 [s, 3]. The latter holds the one, two or three
///            vertices of each site, padded with -1.
///   `.vti`   VTK image data: point data `distance` and `site`, for order 2 also `distance2` and `site2`, raw appended.
///            `metadata` (JSON) is field data.
///
/// The metadata list Blum's version, the source, the sign rule and its reason, and the band. They also describe the
/// site values and the numbering of sites, with counts. A field without site values is written without them. Numbers
/// are stored in the byte order of the machine, which the files state. The same input gives the same bytes.
///
/// A file appears under its name only when it is complete; for .nrrd, all files are complete before any of them
/// appears. A field without sites replaces one with sites as a whole: OUT.site.nrrd is removed if it names OUT.nrrd as
/// its field. The files of order 2 are likewise removed if a field of order 1 replaces one.
/// @throws InvalidOption for another extension.
/// @throws FileError if the system refuses.
/// @throws InvalidGrid if the field does not fit its grid.
/// @throws InvalidMesh for .npz if validate() rejects the mesh, or it lacks sites of the field.
/// @throws Cancelled.
/// Cost: the speed of the disk; no copy of the arrays.
void write_field(const std::filesystem::path& path, const Field& field, const FieldFileInfo& info = {},
                 const Context& context = {});

/// Reads a field written by write_field(), from .nrrd (with OUT.site.nrrd if it exists), .npz or .vti.
///
/// It also reads NRRD files of any scalar type without sites, and .npz files of NumPy (also compressed) that hold at
/// least `distance`. It reads .vti files with raw appended, uncompressed point data `distance`. Values become float32.
/// Facts that a file does not state keep their defaults. Without site values, Field::site is empty.
/// @throws FileError if the file cannot be read.
/// @throws FormatError that names the file and the reason, if its content is wrong.
/// @throws FormatError for the file of another array of a field (OUT.site.nrrd, OUT.distance2.nrrd, OUT.site2.nrrd).
/// @throws InvalidOption for another extension.
/// @throws OutOfMemory.
[[nodiscard]] Field read_field(const std::filesystem::path& path);

/// Reads a field from memory. In messages, `name` stands for the file. For NRRD, only the distances are read.
[[nodiscard]] Field read_field(std::span<const std::byte> bytes, FieldFormat format, const std::string& name = "field");

}  // namespace blum
