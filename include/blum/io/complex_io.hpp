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

/// A complex beside the first of a file.
struct NamedComplex {
  std::string name;
  Complex complex;
};
/// The same for writers, without a copy.
struct NamedComplexRef {
  std::string name;  ///< letters and digits; not "vertex", "edge" or "triangle"
  const Complex* complex = nullptr;
};

/// What a file of a complex holds.
struct ComplexFile {
  Complex complex;
  FileMetadata metadata = {};
  std::vector<NamedComplex> further = {};  ///< .npz only
};

struct ComplexWriteOptions {
  /// Whether columns and metadata that the format cannot hold (.obj: all of them) are left out instead of refused.
  bool allow_loss = false;
  std::vector<NamedComplexRef> further = {};  ///< complexes beside the first, which only .npz files hold
};

/// The most columns that vertices, edges or triangles may have in a file, and the most components of a column.
inline constexpr std::size_t max_file_columns = 1000;
/// The most characters of a column's name, and of a further complex's, in a file.
inline constexpr std::size_t max_file_name = 256;

/// Writes a complex with all its columns; the format goes by the extension.
///
///   .vtp  VTK poly data, raw appended. Vertices of no edge and no triangle are verts, edges are lines, triangles are
///         polys. Columns of vertices are point data. Columns of edges and triangles are cell data: one array for both
///         where name, type and components agree. Cells without the column hold a fill value: -1 in columns of whole
///         numbers, NaN in others; verts hold the value of the vertex where it has a column of that name. The strings
///         `edge_columns` and `triangle_columns` of the field data, JSON, say which column is in which array; the
///         string `metadata` is a JSON object.
///   .ply  binary, little endian: vertices (coordinates in double precision) and triangles with their columns; edges,
///         whose columns are an element of their own, `edge_attributes`, in the edges' order. A column of three
///         components is the properties NAME_x, NAME_y, NAME_z, one of more or two NAME_0, NAME_1, ...; what other
///         names would be read as something else is said by a comment `blum_column ELEMENT PROPERTY COMPONENTS NAME`.
///         A column `radius` is there again as `quality` (float), by which MeshLab colours. Metadata are comments
///         `blum {"key": "text"}`.
///   .obj  v; f; l for every listed edge; p for vertices of nothing else. No columns, no metadata.
///   .npz  `vertices` [n, 3] float64, `edges` [n, 2] and `triangles` [n, 3] int32; `edge_NAME`, `triangle_NAME` and
///         NAME are columns of edges, triangles and vertices, [n] or [n, components] (`vertex_NAME` where NAME alone
///         would be read as something else); `metadata` is a JSON object. A further complex has the same arrays, with
///         its name and `_` before theirs, and no metadata.
///   .glb  binary glTF (see write_gltf()): triangles, edges as lines, vertices of nothing else as points. A column of
///         vertices is the attribute `_NAME` in upper case, unless two names are the same then; metadata are extras.
///         All is in single precision. No columns of edges and triangles, no columns of more than four components, no
///         whole numbers beyond 2^24.
///
/// Indices count from 0 (in .obj from 1). A file appears under its name only when it is complete.
/// @throws InvalidOption for another extension; where the format holds columns, names of other characters than letters,
/// digits, `_`, `-` and `.`, or more than max_file_name of them, more columns or components than max_file_columns, and
/// in .ply files more than 100,000 numbers for a vertex, edge or triangle; metadata with an empty key or one key twice;
/// what the format cannot hold, unless allow_loss says otherwise (further complexes are always refused). InvalidMesh
/// saying problem_of(complex), or for more than 2^31 - 1 vertices; FileError; Cancelled.
void write_complex(const std::filesystem::path& path, const Complex& complex, const FileMetadata& metadata = {},
                   const ComplexWriteOptions& options = {}, const Context& context = {});

/// Reads a file that write_complex wrote, or one of the same form by another program: with any columns, with polygons
/// (.ply, .obj) and lines of several steps (.vtp, .obj), which become triangles and edges that share the attributes,
/// with other numeric types and byte orders. .vtp, .ply and .npz give back exactly what was written; .glb is not read.
/// Whole numbers of 8 and 16 bits become int32, unsigned ones of 32 and 64 bits int64. Left out are lists and unknown
/// elements of .ply, texts of .vtp, and whatever .obj files say beyond vertices, faces and lines. Cell data of .vtp
/// files that Blum did not write are columns of the edges and of the triangles.
/// @throws FileError; FormatError naming the file and the reason, also where problem_of() finds one or the name of a
/// column is not UTF-8; InvalidOption for another extension or a format that is not read; OutOfMemory.
[[nodiscard]] ComplexFile read_complex(const std::filesystem::path& path);

/// Whether files of a path's extension are read as complexes and hold any columns, or several complexes.
[[nodiscard]] bool may_hold_columns(const std::filesystem::path& path);
[[nodiscard]] bool may_hold_further(const std::filesystem::path& path);

/// The same from memory; `name` stands for the file in messages.
[[nodiscard]] ComplexFile read_complex(std::span<const std::byte> bytes, ComplexFormat format,
                                       const std::string& name = "complex");

}  // namespace blum
