// Blum: files of complexes with attributes (VTP, PLY, OBJ, NPZ; GLB is written only). SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/io/file_metadata.hpp"
#include "blum/io/formats.hpp"

namespace blum {

/// Complex that a file holds beside its first one.
struct NamedComplex {
  std::string name;
  Complex complex;
};
/// Reference to such a complex, for writers.
struct NamedComplexRef {
  std::string name;  ///< 1 to max_file_name letters and digits; not "vertex", "edge" or "triangle"
  const Complex* complex = nullptr;
};

/// Content of a file of a complex.
struct ComplexFile {
  Complex complex;
  FileMetadata metadata = {};
  std::vector<NamedComplex> further = {};  ///< .npz only
};

struct ComplexWriteOptions {
  /// True: columns and metadata that the format cannot hold (.obj: all of them) are left out. False: they are rejected.
  bool allow_loss = false;
  std::vector<NamedComplexRef> further = {};  ///< complexes beside the first, for .npz files only; names differ
};

/// Largest number of columns of vertices, edges or triangles in a file, and of components of a column.
inline constexpr std::size_t max_file_columns = 1000;
/// Largest number of characters of a column's name, and of a further complex's, in a file.
inline constexpr std::size_t max_file_name = 256;

/// Writes a complex with all its columns. The extension selects the format.
///
///   `.vtp`  VTK poly data, raw appended. Vertices of no edge and no triangle are verts, edges are lines, triangles are
///           polys. Columns of vertices are point data. Columns of edges and triangles are cell data. A column of edges
///           and one of triangles share an array if name, type and components agree. Cells without the column hold a
///           fill value: -1 in columns of whole numbers, NaN in others. Verts hold the value of the vertex if it has a
///           column of that name. The strings `edge_columns` and `triangle_columns` of the field data, in JSON, list
///           the array of each column. The string `metadata` is a JSON object.
///   `.ply`  Binary, little endian: vertices (coordinates in double precision) and triangles with their columns, then
///           edges. Columns of edges are an element `edge_attributes`, in the edges' order. A column of three
///           components has the properties NAME_x, NAME_y, NAME_z. One of more components, or of two, has NAME_0,
///           NAME_1, ... Comments `blum_column ELEMENT PROPERTY COMPONENTS NAME` describe columns that these rules
///           would read differently. A floating-point column `radius` is repeated as `quality` (float), by which
///           MeshLab colours. Metadata are comments `blum {"key": "text"}`.
///   `.obj`  Lines `v`; `f`; `l` for every listed edge; `p` for vertices of no edge and no triangle. No columns, no
///           metadata.
///   `.npz`  `vertices` [n, 3] float64, `edges` [n, 2] and `triangles` [n, 3] int32. Columns of edges, triangles and
///           vertices are `edge_NAME`, `triangle_NAME` and NAME, [n] or [n, components]. A vertex column is
///           `vertex_NAME` if NAME alone would be read differently. `metadata` is a JSON object. A further complex has
///           the same arrays, with its name and `_` before theirs, and no metadata.
///   `.glb`  Binary glTF (see write_gltf()): triangles, edges as lines, vertices of no edge and no triangle as points.
///           A column of vertices is the attribute `_NAME` in upper case, unless two names would then be the same.
///           Metadata are extras. All numbers are in single precision. It holds no columns of edges and triangles, no
///           columns of more than four components, and no whole numbers beyond 2^24.
///
/// Indices count from 0 (in .obj from 1). A file appears under its name only when it is complete.
/// @throws InvalidOption for another extension.
/// @throws InvalidOption, for formats with columns, if a name has other characters than letters, digits, `_`, `-` and
/// `.`, or more than max_file_name of them. Also for more columns or components than max_file_columns, and in .ply for
/// more than 100,000 numbers for a vertex, edge or triangle.
/// @throws InvalidOption for metadata with an empty or repeated key, and for bad names in options.further.
/// @throws InvalidOption for content that the format cannot hold, unless allow_loss is true. Further complexes are
/// always rejected by other formats than .npz.
/// @throws InvalidMesh with problem_of(complex) as its text, or for more than 2^31 - 1 vertices.
/// @throws FileError, Cancelled.
void write_complex(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata = {},
                   const ComplexWriteOptions& options = {}, const Context& context = {});

/// Reads a file written by write_complex(), or one of the same form by another program. It may have any columns, other
/// numeric types and byte orders. Polygons (.ply, .obj) become triangles, and lines of several steps (.vtp, .obj)
/// become edges. These share the attributes. Files of .vtp, .ply and .npz give back exactly what was written; .glb is
/// not read. Whole numbers of 8 and 16 bits become int32, unsigned ones of 32 and 64 bits int64. Ignored are lists and
/// unknown elements of .ply, texts of .vtp, and statements of .obj other than vertices, faces and lines. Cell data of
/// .vtp files from other programs become columns of both the edges and the triangles.
/// @throws FileError.
/// @throws FormatError that names the file and the reason, also if problem_of() finds one or a column's name is not
/// UTF-8.
/// @throws InvalidOption for another extension or a format that is not read.
/// @throws OutOfMemory.
[[nodiscard]] ComplexFile read_complex(const std::filesystem::path& path);

/// Returns true if files of a path's extension are read as complexes and may hold columns, or several complexes.
[[nodiscard]] bool may_hold_columns(const std::filesystem::path& path);
[[nodiscard]] bool may_hold_further(const std::filesystem::path& path);

/// Reads a complex from memory. In messages, `name` stands for the file.
[[nodiscard]] ComplexFile read_complex(std::span<const std::byte> bytes, ComplexFormat format,
                                       const std::string& name = "complex");

}  // namespace blum
