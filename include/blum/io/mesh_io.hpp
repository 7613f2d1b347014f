// Blum: reading and writing meshes (OBJ, OFF, STL, PLY; GLB is written only). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "blum/core/error.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/io/formats.hpp"

namespace blum {

struct MeshReadOptions {
  /// Tolerance for merging vertices after reading (see weld()), in mesh units. With 0, vertices at equal positions are
  /// merged. If unset, vertices at equal positions are merged for STL, which has no shared vertices. Meshes of other
  /// formats are then not welded.
  std::optional<double> weld = {};
  /// If true and `weld` is above 0, MeshFile::exact is the mesh in which only vertices at equal positions are merged.
  bool keeps_exact = false;
};

/// Facts about a mesh file, and about the changes made after reading.
struct MeshFileInfo {
  MeshFormat format{"OBJ"};
  bool binary = false;
  std::size_t vertices = 0;         ///< Number of vertices in the file; 3 per triangle for STL.
  std::size_t faces = 0;            ///< Number of triangles and polygons in the file.
  std::size_t polygons = 0;         ///< Number of polygons with more than 3 corners, which were cut into triangles.
  std::size_t fan_polygons = 0;     ///< Number of `polygons` that became fans because no proper cut was found (see
                                    ///< read_mesh()).
  bool welded = false;              ///< True if weld() ran.
  std::size_t merged_vertices = 0;  ///< Number of vertices removed by weld().
};

struct MeshFile {
  TriangleMesh mesh = {};
  MeshFileInfo info = {};
  std::optional<TriangleMesh> exact = {};  ///< if requested (MeshReadOptions::keeps_exact)
};

/// Reads a mesh; the extension selects the format. Coordinates keep double precision. Vertices keep their order.
/// Vertices that no triangle, segment or point uses are kept, too.
///
///   `OBJ`  The statements `v`, `f`, `l` (segments) and `p` (points) are read; other statements are ignored. Indices
///          are `i`, `i/t`, `i//n` or `i/t/n`, also negative. A backslash at the end of a line continues the line.
///   `OFF`  Text with any of the prefixes ST, C, N. On a line, text after the coordinates or corners is ignored. Binary
///          files and 4- or n-dimensional files are rejected.
///   `STL`  Text or binary, distinguished by size and content, not by the word "solid". Normals and colours are
///          ignored.
///   `PLY`  Text, or binary in either byte order. Scalars and list counts may have any type. The elements `vertex`,
///          `face`, `tristrips` and `edge` (vertex1, vertex2: segments) are read. Other elements and properties are
///          ignored.
///
/// A file with vertices and nothing else is a point cloud: every vertex is in `points`. Polygons are cut into
/// triangles. A strictly convex polygon becomes a fan of triangles at its first corner. Other polygons are projected
/// along the coordinate axis nearest to their mean normal, and cut by ear clipping. Ear clipping is correct for every
/// simple planar polygon, even if bridges join holes to the polygon's outline. If a polygon crosses itself, has no
/// area, or needs too many steps, it becomes a fan. The limit of steps is 500 per corner plus 2e8 per file. Triangles
/// with the same vertex at two corners are kept, unless welding is requested.
///
/// Cost: O(file size) time and memory; the whole file is held in memory while it is read.
/// @throws FileError if the file cannot be read, or its extension is not known.
/// @throws FormatError with the file and the line (text) or byte (binary). FormatError is thrown for broken or
/// truncated content, counts that exceed the size of the file, and indices out of range. FormatError is also thrown for
/// faces with fewer than 3 corners, and for coordinates that are not finite.
/// @throws InvalidOption for a weld tolerance that is negative or not finite, or a format that is not read.
/// @throws OutOfMemory.
[[nodiscard]] TriangleMesh read_mesh(const std::filesystem::path& path, const MeshReadOptions& options = {});
/// Reads a mesh from memory. In messages, `name` is used as the name of the file.
[[nodiscard]] TriangleMesh read_mesh(std::span<const std::byte> data, MeshFormat format,
                                     const MeshReadOptions& options = {}, std::string_view name = "mesh");

/// Reads a mesh as read_mesh() does, and also returns facts about the file.
[[nodiscard]] MeshFile read_mesh_file(const std::filesystem::path& path, const MeshReadOptions& options = {});
[[nodiscard]] MeshFile read_mesh_file(std::span<const std::byte> data, MeshFormat format,
                                      const MeshReadOptions& options = {}, std::string_view name = "mesh");

/// Writes a mesh in the format of the extension. The file appears complete or not at all (see AtomicFile).
///
/// OBJ and OFF files are text, from which exactly the same doubles are read back. PLY is binary, little endian, with
/// double coordinates. STL is binary, in single precision. GLB is glTF in one file, also in single precision (see
/// write_gltf()). Content that a format cannot hold is rejected, not dropped: segments and points in STL, and segments
/// in OFF. Points are rejected in OFF and PLY, unless the mesh is a point cloud in which every vertex is a point.
/// Vertices that no triangle uses are left out in STL.
/// @throws InvalidMesh if validate() rejects the mesh, or a vertex is not finite.
/// @throws FileError if the file cannot be written, the extension is not known or the format cannot hold the mesh.
void write_mesh(const std::filesystem::path& path, const MeshView& mesh);

}  // namespace blum
