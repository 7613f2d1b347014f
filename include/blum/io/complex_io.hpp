// Blum: files of complexes with columns (VTP, PLY, OBJ, NPZ; GLB is written only). SPDX-License-Identifier: Apache-2.0
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

/// A further complex in a file, in addition to the first one.
struct NamedComplex {
  std::string name;
  Complex complex;
};
/// Reference to a further complex, for writers.
struct NamedComplexRef {
  std::string name;  ///< 1 to max_file_name letters and digits; not "vertex", "edge" or "triangle"
  const Complex* complex = nullptr;
};

/// Content of a complex file.
struct ComplexFile {
  Complex complex;
  FileMetadata metadata = {};
  std::vector<NamedComplex> further = {};  ///< .npz only
};

struct ComplexWriteOptions {
  /// If true, columns and metadata that the format cannot hold are left out; .obj can hold none. If false, columns and
  /// metadata that the format cannot hold are rejected.
  bool allow_loss = false;
  std::vector<NamedComplexRef> further = {};  ///< complexes in addition to the first, only for .npz files; their names
                                              ///< must differ
};

/// Largest number of vertex columns in a file. The numbers of edge columns, of triangle columns, and of components of
/// one column have the same limit.
inline constexpr std::size_t max_file_columns = 1000;
/// Largest number of characters of the name of a column or of a further complex in a file.
inline constexpr std::size_t max_file_name = 256;

/// Writes a complex with all its columns. The extension selects the format.
///
///   `.vtp`  VTK poly data, with raw appended data. Vertices that belong to no edge and no triangle are verts, edges
///           are lines, triangles are polys. Columns of vertices are point data. Columns of edges and triangles are
///           cell data. A column of edges and a column of triangles are in the same array if they have the same name,
///           type and number of components. Cells without the column have a fill value: -1 in columns of whole numbers,
///           NaN in others. If a column of vertices has the same name, a vert has its vertex's value in this column.
///           The field data `edge_columns` and `triangle_columns` are JSON texts that list the array of each column.
///           The field data `metadata` is a JSON object.
///   `.ply`  Binary, little endian: vertices (coordinates in double precision) and triangles with their columns, then
///           edges. Columns of edges are an element `edge_attributes`, in the order of the edges. A column of three
///           components has the properties NAME_x, NAME_y, NAME_z. A column of two, or more than three, components has
///           NAME_0, NAME_1, ... Comments `blum_column ELEMENT PROPERTY COMPONENTS NAME` describe columns that a reader
///           could not restore from the names. A floating-point column `radius` is repeated as `quality` (float), which
///           MeshLab uses for colours. Metadata are comments `blum {"key": "text"}`.
///   `.obj`  Lines `v` and `f`, `l` for each edge of the complex, and `p` for vertices that belong to no edge and no
///           triangle. Files of .obj hold no columns and no metadata.
///   `.npz`  `vertices` [n, 3] float64, `edges` [n, 2] and `triangles` [n, 3] int32. Columns of edges, triangles and
///           vertices are `edge_NAME`, `triangle_NAME` and NAME, [n] or [n, components]. A column of vertices is
///           `vertex_NAME` if NAME alone would have another meaning. `metadata` is a JSON object. A further complex has
///           the same arrays, with its name and `_` as a prefix, but no metadata.
///   `.glb`  Binary glTF (see write_gltf()): triangles, edges as lines, and vertices that belong to no edge and no
///           triangle as points. A column of vertices is the attribute `_NAME`. NAME is in upper case, unless two names
///           would then be the same. Metadata are extras. All numbers are in single precision. The format cannot hold
///           columns of edges and triangles, columns of more than four components, and whole numbers beyond 2^24.
///
/// Indices count from 0 (in .obj from 1). A file appears under its name only when it is complete.
/// @throws InvalidOption for another extension.
/// @throws InvalidOption, in formats with columns, if a column's name has other characters than letters, digits, `_`,
/// `-` and `.`, or more than max_file_name characters. Also thrown for more columns or components than
/// max_file_columns, and in .ply for more than 100,000 numbers for each vertex, edge or triangle.
/// @throws InvalidOption for metadata with an empty or repeated key, and for bad names in options.further.
/// @throws InvalidOption for content that the format cannot hold, unless allow_loss is true. Further complexes are
/// rejected in all formats except .npz, even if allow_loss is true.
/// @throws InvalidMesh if problem_of(complex) finds a problem, with its text, or for more than 2^31 - 1 vertices.
/// @throws FileError, Cancelled.
void write_complex(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata = {},
                   const ComplexWriteOptions& options = {}, const Context& context = {});

/// Reads a file written by write_complex(), or a file of the same form written by another program. The file may have
/// any columns, numeric types and byte order. Polygons (.ply, .obj) become triangles, and lines of several steps (.vtp,
/// .obj) become edges. The triangles and edges get the column values of their polygon or line. If write_complex() wrote
/// a .vtp, .ply or .npz file, the result equals the written complex exactly. GLB files are not read. Whole numbers of 8
/// and 16 bits become int32. Unsigned whole numbers of 32 and 64 bits become int64. The reader ignores lists and
/// unknown elements of .ply, texts of .vtp, and statements of .obj other than vertices, faces and lines. Cell data of
/// .vtp files from other programs become columns of both the edges and the triangles.
/// @throws FileError.
/// @throws FormatError with the file and the reason, also if problem_of() finds a problem, or if a column's name is not
/// UTF-8.
/// @throws InvalidOption for another extension or a format that is not read.
/// @throws OutOfMemory.
[[nodiscard]] ComplexFile read_complex(const std::filesystem::path& path);

/// Return true if files with the extension of a path are read as complexes, and can hold columns (may_hold_columns())
/// or further complexes (may_hold_further()). For an unknown extension, may_hold_columns() examines the first bytes of
/// the file.
[[nodiscard]] bool may_hold_columns(const std::filesystem::path& path);
[[nodiscard]] bool may_hold_further(const std::filesystem::path& path);

/// Reads a complex from memory. In messages, `name` is used as the name of the file.
[[nodiscard]] ComplexFile read_complex(std::span<const std::byte> bytes, ComplexFormat format,
                                       const std::string& name = "complex");

}  // namespace blum
