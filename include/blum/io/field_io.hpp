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

/// Further content of a field file. All members are optional. The mesh and the sites are not copied, and must outlive
/// this object.
struct FieldFileInfo {
  /// Mesh of the field. The vertices of the mesh, and the vertices of its sites, are written to .npz files.
  const MeshView* mesh = nullptr;
  /// Sites of `mesh`. If the sites are needed but not given, they are computed from `mesh`.
  const SiteTable* sites = nullptr;
  /// Source of the shape, for example a file name.
  std::string source = {};
  /// Version of Blum that computed the field.
  std::string version = {};
  /// Meaning of the world axes, with the names of NRRD: VoxelImage::space of the field's image. NRRD files hold this
  /// text as their `space`, and other formats hold it in their metadata. In NRRD files, a name that NRRD does not
  /// define is left out.
  std::string space = {};
};

/// Writes a field. The extension selects the format. In all formats, distances are float32 in mesh units (negative
/// inside when signed). Sites are int32 (-1: no site). Distances and sites have one value per node, and x varies
/// fastest.
///
///   `.nrrd`  The distances, raw. The sites are written to a second file: OUT.site.nrrd for OUT.nrrd. The second
///            distances and sites of a field of order 2 are written to OUT.distance2.nrrd and OUT.site2.nrrd. Metadata
///            are key/value pairs.
///   `.npz`   Uncompressed arrays for NumPy: `distance` and `site`, for order 2 also `distance2` and `site2`, [z, y,
///            x]. `origin` and `spacing` are float64 [3] in x, y, z order. `direction` is float64 [3, 3]; column a is
///            the direction of index axis a. `metadata` is one string of JSON. If the mesh is given and the field has
///            sites of a mesh, there are also `vertices` float64 [m, 3] and `site_vertices` int32 [s, 3].
///            `site_vertices` holds the one, two or three vertices of each site, padded with -1.
///   `.vti`   VTK image data: point data `distance` and `site`, for order 2 also `distance2` and `site2`, as raw
///            appended data. `metadata` (JSON) is field data.
///
/// The metadata contain Blum's version, the source, the sign rule and its reason, and the band. The metadata also
/// describe the site values and, if FieldFileInfo::sites is given, the numbers of vertices, edges and faces. If the
/// field has no sites, no sites are written. Numbers are stored in the byte order of the machine, which is stated in
/// the files. The same input gives the same bytes.
///
/// A file appears under its name only when it is complete. For .nrrd, all files are complete before any of them
/// appears. If a field without sites replaces OUT.nrrd, the old OUT.site.nrrd is removed if it names OUT.nrrd as its
/// field. If a field of order 1 replaces a field of order 2, the files of the second distances and second sites are
/// removed, too.
/// @throws InvalidOption for another extension.
/// @throws FileError if the system reports an error.
/// @throws InvalidGrid if the field does not fit its grid.
/// @throws InvalidMesh for .npz if validate() rejects the mesh, or if the mesh does not have all sites of the field.
/// @throws Cancelled.
/// Cost: limited by the speed of the disk; the arrays are not copied.
void write_field(const std::filesystem::path& path, const Field& field, const FieldFileInfo& info = {},
                 const Context& context = {});

/// Reads a field written by write_field(), from a .nrrd, .npz or .vti file. If the path is OUT.nrrd, the function also
/// reads OUT.site.nrrd and the files of order 2, if these files exist.
///
/// Files of other programs are also read. NRRD files may have any scalar type, and have no sites. Files of .npz from
/// NumPy (also compressed) must have at least the array `distance`. Files of .vti must have raw appended, uncompressed
/// point data `distance`. Distances become float32. Members of Field that a file does not state keep their defaults. If
/// a file has no sites, Field::site is empty.
/// @throws FileError if the file cannot be read.
/// @throws FormatError with the file and the reason, if its content is wrong.
/// @throws FormatError if `path` is a file with the sites, second distances or second sites of a field (OUT.site.nrrd,
/// OUT.distance2.nrrd, OUT.site2.nrrd).
/// @throws InvalidOption for another extension.
/// @throws OutOfMemory.
[[nodiscard]] Field read_field(const std::filesystem::path& path);

/// Reads a field from memory. In messages, `name` is used as the name of the file. From NRRD, only the distances are
/// read.
[[nodiscard]] Field read_field(std::span<const std::byte> bytes, FieldFormat format, const std::string& name = "field");

}  // namespace blum
