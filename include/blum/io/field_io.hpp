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

/// What a field file holds besides the field. Everything is optional; nothing is copied or owned.
struct FieldFileInfo {
  /// The mesh that the field was computed from: .npz files get its vertices and the vertices of its sites.
  const MeshView* mesh = nullptr;
  /// The sites of that mesh. Without it, they are found again from `mesh` where they are needed.
  const SiteTable* sites = nullptr;
  /// Where the shape came from, for example a file name.
  std::string source = {};
  /// Blum's version.
  std::string version = {};
  /// What the world axes are, as NRRD names it: VoxelImage::space of the image that the field was computed from. NRRD
  /// files get it as their `space`, the other formats in their metadata; a name that NRRD does not know is left out.
  std::string space = {};
};

/// Writes a field; the format goes by the extension. In all of them, distances are float32 in mesh units (negative
/// inside when signed) and sites int32 (-1 where there is none), one per node, x fastest.
///
///   .nrrd  the distances, raw; the sites go to a second file, OUT.site.nrrd for OUT.nrrd, and of fields of order 2 the
///          second distances and sites to OUT.distance2.nrrd and OUT.site2.nrrd. Metadata as key/value pairs.
///   .npz   uncompressed arrays for NumPy: `distance` and `site`, of order 2 `distance2` and `site2` [z, y, x];
///   `origin`, `spacing` float64 [3] in x, y, z
///          order; `direction` float64 [3, 3], column a being the direction of index axis a; `metadata`, one string
///          of JSON. With a mesh and mesh sites also `vertices` float64 [m, 3] and `site_vertices` int32 [s, 3]: the
///          one, two or three vertices of each site, padded with -1.
///   .vti   VTK image data: point data `distance` and `site`, of order 2 `distance2` and `site2`, raw appended;
///   `metadata` (JSON) as field data.
///
/// The metadata name Blum's version, the source, the sign rule and its reason, the band, what the site values count
/// and how sites are numbered, with counts. A field without site values is written without them. Numbers are stored
/// in the byte order of the machine, which the files state. The same input gives the same bytes.
///
/// A file appears under its name only when it is complete; for .nrrd both are complete before either appears. A field
/// without sites that replaces one with sites takes its place as a whole: OUT.site.nrrd goes, where it says that it
/// belongs to OUT.nrrd; so do the files of order 2, when a field of order 1 replaces one.
/// @throws InvalidOption for another extension; FileError when the system refuses; InvalidGrid when the field does not
/// fit its grid; InvalidMesh for a mesh (.npz files hold it) that validate() refuses or that lacks sites of the field;
/// Cancelled.
/// Cost: the speed of the disk; no copy of the arrays.
void write_field(const std::filesystem::path& path, const Field& field, const FieldFileInfo& info = {},
                 const Context& context = {});

/// Reads a field that write_field wrote, from .nrrd (with OUT.site.nrrd where it is there), .npz or .vti.
///
/// Also reads NRRD files of any scalar type without sites, .npz files of NumPy (compressed too) that hold at least
/// `distance`, and .vti files with raw appended, uncompressed point data `distance`. Values become float32. What a file
/// does not say stays at its default; without site values, Field::site is empty.
/// @throws FileError when the file cannot be read; FormatError, naming the file and the reason, when its content is
/// wrong or the file holds the sites of a field (OUT.site.nrrd); InvalidOption for another extension; OutOfMemory.
[[nodiscard]] Field read_field(const std::filesystem::path& path);

/// The same from memory; `name` stands for the file in messages. For NRRD, sites are not read.
[[nodiscard]] Field read_field(std::span<const std::byte> bytes, FieldFormat format, const std::string& name = "field");

}  // namespace blum
