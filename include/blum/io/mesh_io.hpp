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
  /// Tolerance for merging vertices after reading (see weld()), in mesh units; 0: exactly equal ones. Unset: exactly
  /// equal ones for STL, which has no shared vertices; none for the other formats.
  std::optional<double> weld = {};
  /// If `weld` is above 0: also keep the mesh with only equal vertices merged, as MeshFile::exact.
  bool keeps_exact = false;
};

/// Content of a mesh file, before Blum changed anything.
struct MeshFileInfo {
  MeshFormat format{"OBJ"};
  bool binary = false;
  std::size_t vertices = 0;         ///< Vertices in the file; 3 per triangle for STL.
  std::size_t faces = 0;            ///< Triangles and polygons in the file.
  std::size_t polygons = 0;         ///< Polygons with more than 3 corners, which were cut into triangles.
  std::size_t fan_polygons = 0;     ///< Those of `polygons` for which no proper cut was found (see read_mesh).
  bool welded = false;              ///< True if weld() ran.
  std::size_t merged_vertices = 0;  ///< Number of vertices removed by weld().
};

struct MeshFile {
  TriangleMesh mesh = {};
  MeshFileInfo info = {};
  std::optional<TriangleMesh> exact = {};  ///< if requested (MeshReadOptions::keeps_exact)
};

/// Reads a mesh; the extension selects the format. Coordinates keep double precision. Vertices keep their order, and
/// stay even if nothing names them.
///
///   `OBJ`  `v`, `f`, `l` (segments), `p` (points). Indices are `i`, `i/t`, `i//n`, `i/t/n`, also negative. A backslash
///          continues a line. Everything else is ignored.
///   `OFF`  Text, with any of the prefixes ST, C, N. Text after coordinates or corners on a line is ignored. Binary and
///          4- or n-dimensional OFF are rejected.
///   `STL`  Text or binary, distinguished by size and content, not by the word "solid". Normals and colours are
///          ignored.
///   `PLY`  Text or binary of either byte order, scalars and list counts of every type. The elements are `vertex`,
///          `face`, `tristrips` and `edge` (vertex1, vertex2: segments). Other elements and properties are ignored.
///
/// A file with vertices and nothing else is a point cloud: every vertex is in `points`. Polygons are cut into
/// triangles. Strictly convex ones become a fan from their first corner. Others are cut by ear clipping, seen along the
/// coordinate axis nearest to their mean normal. That is right for every simple planar polygon, also with holes joined
/// to the outline by a bridge. A polygon without a proper cut becomes a fan: one that crosses itself, has no area, or
/// takes too many steps. The limit is 500 steps per corner plus 2e8 steps per file. Triangles that name a vertex twice
/// stay as they are, unless welding is requested.
///
/// Cost: O(file size) time and memory; the whole file is held in memory while it is read.
/// @throws FileError if the file cannot be read, or its extension is not known.
/// @throws FormatError that names file and line (text) or byte (binary). It is thrown for broken or cut-off content,
/// counts that the file cannot hold, and indices out of range. Also for faces of fewer than 3 corners, and coordinates
/// that are not finite.
/// @throws InvalidOption for a weld tolerance that is negative or not finite, or a format that is not read.
/// @throws OutOfMemory.
[[nodiscard]] TriangleMesh read_mesh(const std::filesystem::path& path, const MeshReadOptions& options = {});
/// Reads a mesh from memory. In messages, `name` stands for the file.
[[nodiscard]] TriangleMesh read_mesh(std::span<const std::byte> data, MeshFormat format,
                                     const MeshReadOptions& options = {}, std::string_view name = "mesh");

/// Reads a mesh as read_mesh() does, and returns what the file held.
[[nodiscard]] MeshFile read_mesh_file(const std::filesystem::path& path, const MeshReadOptions& options = {});
[[nodiscard]] MeshFile read_mesh_file(std::span<const std::byte> data, MeshFormat format,
                                      const MeshReadOptions& options = {}, std::string_view name = "mesh");

/// Writes a mesh in the format of the extension. The file appears complete or not at all (see AtomicFile).
///
/// OBJ and OFF are text that reads back to the same doubles. PLY is binary, little endian, with double coordinates. STL
/// is binary, in single precision. GLB is glTF in one file, also in single precision (see write_gltf()). Content that a
/// format cannot hold is rejected, not dropped: segments and points in STL, and segments in OFF. OFF and PLY hold
/// points only if the mesh is a point cloud that names every vertex. STL leaves out vertices that no triangle names.
/// @throws InvalidMesh if validate() rejects the mesh, or a vertex is not finite.
/// @throws FileError if the file cannot be written, the extension is not known or the format cannot hold the mesh.
void write_mesh(const std::filesystem::path& path, const MeshView& mesh);

}  // namespace blum
