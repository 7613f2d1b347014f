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
  /// Merge vertices after reading (see weld()): a tolerance in mesh units, 0 for exactly equal ones.
  /// Unset: exactly equal ones for STL, which has no shared vertices; none for the other formats.
  std::optional<double> weld = {};
  /// Where `weld` is above 0: keep the mesh in which equal vertices alone are merged, too, as MeshFile::exact.
  bool keeps_exact = false;
};

/// What a mesh file held, before Blum changed anything.
struct MeshFileInfo {
  MeshFormat format{"OBJ"};
  bool binary = false;
  std::size_t vertices = 0;         ///< vertices in the file; 3 a triangle for STL
  std::size_t faces = 0;            ///< triangles and polygons in the file
  std::size_t polygons = 0;         ///< those of them with more than 3 corners, which were cut into triangles
  std::size_t fan_polygons = 0;     ///< those of `polygons` for which no proper cut was found (see read_mesh)
  bool welded = false;              ///< whether weld() ran
  std::size_t merged_vertices = 0;  ///< by how many vertices weld() made the mesh smaller
};

struct MeshFile {
  TriangleMesh mesh = {};
  MeshFileInfo info = {};
  std::optional<TriangleMesh> exact = {};  ///< where it was asked for (MeshReadOptions::keeps_exact)
};

/// Reads a mesh; the extension tells the format. Coordinates keep double precision; vertices keep their order, and stay
/// also where nothing names them.
///
/// - OBJ: `v`, `f`, `l` (segments), `p` (points); `i`, `i/t`, `i//n`, `i/t/n`, also negative; a backslash continues a
///   line. Everything else is passed over.
/// - OFF: text, with any of the prefixes ST, C, N; what follows coordinates or corners on a line is passed over. Binary
///   and 4- or n-dimensional OFF are refused.
/// - STL: text or binary, told apart by size and content, not by the word "solid"; normals and colours are passed over.
/// - PLY: text or binary of either byte order, scalars and list counts of every type; elements `vertex`, `face`,
///   `tristrips` and `edge` (vertex1, vertex2: segments); other elements and properties are passed over.
///
/// A file with vertices and nothing else is a point cloud: every vertex is in `points`. Polygons are cut into
/// triangles: strictly convex ones as a fan from their first corner, others by ear clipping as seen along the
/// coordinate axis nearest to their mean normal, which is right for every simple planar polygon, also with holes joined
/// to the outline by a bridge. One that crosses itself, has no area, or is so tangled that it takes more than
/// 500 steps a corner and 2e8 a file, is cut as a fan. Triangles that name a vertex twice stay as they are, unless
/// welding is asked for.
///
/// Cost: O(file size) time and memory; the whole file is held in memory while it is read.
/// @throws FileError when the file cannot be read, or when its extension is not known.
/// @throws FormatError naming file and line (text) or byte (binary): broken or cut-off content, counts that the file
///         cannot hold, indices out of range, faces of fewer than 3 corners, coordinates that are not finite.
/// @throws InvalidOption for a weld tolerance that is negative or not finite, or a format that is not read;
/// OutOfMemory.
[[nodiscard]] TriangleMesh read_mesh(const std::filesystem::path& path, const MeshReadOptions& options = {});
/// The same from memory; `name` stands for the file in messages.
[[nodiscard]] TriangleMesh read_mesh(std::span<const std::byte> data, MeshFormat format,
                                     const MeshReadOptions& options = {}, std::string_view name = "mesh");

/// As read_mesh, with what the file held.
[[nodiscard]] MeshFile read_mesh_file(const std::filesystem::path& path, const MeshReadOptions& options = {});
[[nodiscard]] MeshFile read_mesh_file(std::span<const std::byte> data, MeshFormat format,
                                      const MeshReadOptions& options = {}, std::string_view name = "mesh");

/// Writes a mesh in the format of the extension; the file appears complete or not at all (see AtomicFile).
///
/// OBJ and OFF are text that reads back to the same doubles; PLY is binary, little endian, with double coordinates; STL
/// is binary and holds single precision only; GLB is glTF in one file, in single precision as well (see write_gltf()).
/// What a format cannot hold is refused, not dropped: segments and points in
/// STL; segments in OFF; in OFF and PLY, points unless the mesh is a point cloud that names every vertex. STL leaves
/// out vertices that no triangle names.
/// @throws InvalidMesh when validate() refuses the mesh, or a vertex is not finite.
/// @throws FileError when the file cannot be written, the extension is not known or the format cannot hold the mesh.
void write_mesh(const std::filesystem::path& path, const MeshView& mesh);

}  // namespace blum
