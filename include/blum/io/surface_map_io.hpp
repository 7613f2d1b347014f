// Blum: files of surface maps (NPZ, PNG, GLB, PLY, VTP). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/io/color_scale.hpp"
#include "blum/io/file_metadata.hpp"
#include "blum/io/png_io.hpp"
#include "blum/surface_map/surface_distance_map.hpp"

namespace blum {

/// Colours and texts of files of surface maps.
struct SurfaceMapWriteOptions {
  /// Distances at the ends of the colours of .png and .glb files, finite, the first less than the second. Unset: the
  /// upper end is the largest finite distance. The lower end is 0 for distances, or the smallest distance if the map is
  /// signed and it is negative. For thickness the lower end is the smallest one, unless all are equal. An empty range
  /// gets a length of 1.
  std::optional<std::pair<double, double>> range = {};
  /// Units of distances, for example "mm", for the colour bar and the metadata; may be empty.
  std::string units = {};
};

/// Writes a surface map. The extension selects the format. All formats but .png hold the triangles of the mesh.
/// Segments and points have no texels and are left out.
///
///   `.npz`  Everything. `distance` [h, w] and `vector` [h, w, 3] are float32, `site` and `triangle` [h, w] int32 (-1:
///           none), with rows from the top. `corners` [t, 3, 2] float64 holds the places of the triangles' corners in
///           texels (x right, y down). `vertices` [n, 3] is float64, `triangles` [t, 3] int32, `vertex_distance` [n]
///           float64. `triangle_error` (if the map has errors), `triangle_smallest`, `triangle_largest` and
///           `triangle_mean` [t] are float32. `metadata` is a JSON object.
///   `.png`  The texture in colours, texel (i, j) as pixel (i, j). Beside it stands a bar with numbers and units.
///   `.glb`  Binary glTF (see write_gltf()): the mesh with the texture in colours. Vertices appear once for each chart
///           that contains them. Exact distances at vertices are the attribute `_DISTANCE`. Extras hold the metadata
///           below, `colors` ("sequential" or "diverging"), and `range` and `color_range` as two numbers each.
///   `.ply`, `.vtp`  The mesh with the exact distances at its vertices (column `distance`, float64). Triangles have the
///                   columns `smallest`, `largest`, `mean` and, if the map has errors, `error` (float32). See
///                   write_complex().
///
/// Colours are those of ColorScale: sequential, or diverging if the map is signed; grey for texels without a value.
/// Texels of no triangle get the colour of the closest charts, up to four texels away, and are white beyond. So no
/// other colour bleeds in.
/// @param metadata  written before the entries of the map: `content` ("surface map"), `quantity`, `units`, `sign_rule`,
///                  `sign_reason`, `range`, `largest_error`, and `separate_charts` ("true" or "false", only in .npz).
///                  All are texts. `range` is the smallest and the largest finite distance of texels. A given key
///                  replaces that of the map (in .glb not `range`, `colors` and `color_range`).
/// @throws InvalidOption for another extension, an invalid range, or metadata with an empty or repeated key.
/// @throws InvalidOption in .npz for metadata with another quantity, sign rule or kind of charts than the map's.
/// @throws InvalidMesh for a mesh that validate() rejects, or a map that is not of this mesh or lacks parts.
/// @throws InvalidMesh in .ply and .vtp for a triangle that names a vertex twice, or a vertex of no triangle that is
/// not finite.
/// @throws FileError, also for .glb of more than 4 GiB.
/// @throws OutOfMemory, Cancelled.
void write_surface_map(const std::filesystem::path& path, const MeshView& mesh, const SurfaceMap& map,
                       const FileMetadata& metadata = {}, const SurfaceMapWriteOptions& options = {},
                       const Context& context = {});

/// Surface map in a file.
struct SurfaceMapFile {
  TriangleMesh mesh;  ///< triangles only
  SurfaceMap map;     ///< all but `phases` and `warnings`
  FileMetadata metadata;
};

/// Reads the .npz files of write_surface_map(): the same numbers, bit by bit. It checks types and shapes of arrays, the
/// ranges of indices, that charts lie within the texture, and that texels lie beside their triangle's chart. Sites are
/// not compared with the other mesh, which the file does not hold.
/// @throws FormatError that states the reason.
/// @throws FileError, OutOfMemory.
/// Cost: about that of reading the file. The content of the file bounds the memory.
[[nodiscard]] SurfaceMapFile read_surface_map(const std::filesystem::path& path);
/// Reads a surface map from memory. @param name  stands for the file in messages.
[[nodiscard]] SurfaceMapFile read_surface_map(std::span<const std::byte> bytes, const std::string& name);

/// Returns true if a file is an .npz file with the arrays of a surface map. Returns false if it cannot be read.
[[nodiscard]] bool holds_surface_map(const std::filesystem::path& path);

/// Returns the smallest and the largest finite distance of the texels that belong to triangles; nullopt if none is
/// finite.
[[nodiscard]] std::optional<std::pair<double, double>> finite_range(const SurfaceMap& map);

/// Returns true if some of the distances may be negative.
[[nodiscard]] bool is_signed(const SurfaceMap& map);

/// Returns the colours that write_surface_map() gives to distances.
/// @throws InvalidOption for an invalid range.
[[nodiscard]] ColorScale color_scale_of(const SurfaceMap& map, const SurfaceMapWriteOptions& options = {});

/// Texture in memory.
struct ColorTexture {
  std::uint32_t width = 0;           ///< texels
  std::uint32_t height = 0;          ///< texels
  std::vector<std::uint8_t> pixels;  ///< red, green, blue; rows from the top
  [[nodiscard]] PixelView view() const { return {pixels, width, height, PngChannels::rgb}; }
};
/// Returns a map in colours, as write_surface_map() writes it.
/// @throws InvalidMesh for a map that lacks parts.
/// @throws OutOfMemory, Cancelled.
/// Cost: about 15 ns per texel.
[[nodiscard]] ColorTexture color_texture(const SurfaceMap& map, const ColorScale& scale, const Context& context = {});

}  // namespace blum
