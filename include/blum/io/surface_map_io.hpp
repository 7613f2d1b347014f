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

/// Colours and units for files of surface maps.
struct SurfaceMapWriteOptions {
  /// Distances at the two ends of the colour scale of .png and .glb files. Both distances must be finite, and the first
  /// less than the second. The default upper end is the largest finite distance. The default lower end is 0. If the map
  /// is signed and its smallest distance is negative, the default lower end is this smallest distance. For thickness,
  /// the default lower end is the smallest thickness, or 0 if all values are equal. If the upper end is not above the
  /// lower end, the upper end is set to the lower end plus 1.
  std::optional<std::pair<double, double>> range = {};
  /// Units of distances, for example "mm", for the colour bar and the metadata; may be empty.
  std::string units = {};
};

/// Writes a surface map. The extension selects the format. All formats but .png hold the triangles of the mesh.
/// Segments and points of the mesh have no texels and are left out.
///
///   `.npz`  Everything. Arrays of a texture of h rows and w columns, for a mesh of n vertices and t triangles.
///           `distance` [h, w] and `vector` [h, w, 3] are float32. `site` and `triangle` [h, w] are int32 (-1: none).
///           Rows are listed from the top. `corners` [t, 3, 2] (float64) holds the positions of the triangles' corners
///           in the texture, in texels (x to the right, y down). `vertices` [n, 3] is float64, `triangles` [t, 3]
///           int32, `vertex_distance` [n] float64. `triangle_error` (if the map has errors), `triangle_smallest`,
///           `triangle_largest` and `triangle_mean` [t] are float32. `metadata` is a JSON object.
///   `.png`  The texture in colours; texel (i, j) is pixel (i, j). A colour bar with numbers and units is to the right
///           of the texture.
///   `.glb`  Binary glTF (see write_gltf()): the mesh with the texture in colours. A vertex is written once for each
///           chart that contains it. Exact distances at vertices are the attribute `_DISTANCE`. Extras hold the
///           metadata (see the parameter `metadata`), `colors` ("sequential" or "diverging"), and `range` and
///           `color_range`, each as two numbers.
///   `.ply`, `.vtp`  The mesh with exact distances at its vertices (column `distance`, float64). Triangles have the
///                   columns `smallest`, `largest`, `mean` and, if the map has errors, `error` (float32). See
///                   write_complex().
///
/// Colours are those of ColorScale: diverging if the map is signed, else sequential. Texels of a triangle without a
/// value are grey. Texels of no triangle get the colour of the closest chart if this chart is at most four texels away,
/// else they are white. So interpolation at the borders of charts uses only colours of the chart.
/// @param metadata  further metadata, written before the metadata of the map. The metadata of the map are `content`
///                  ("surface map"), `quantity`, `units`, `sign_rule`, `sign_reason`, `range`, `largest_error`, and
///                  `separate_charts` ("true" or "false", only in .npz). All are texts. `range` is the smallest and the
///                  largest finite distance of texels. An entry in `metadata` replaces the entry of the map with the
///                  same key (in .glb except `range`, `colors` and `color_range`).
/// @throws InvalidOption for another extension, an invalid range, or metadata with an empty or repeated key.
/// @throws InvalidOption in .npz if `metadata` has another quantity, sign rule or kind of charts than the map.
/// @throws InvalidMesh if validate() rejects the mesh, or if the map belongs to another mesh, has no atlas, or has no
/// values of texels.
/// @throws InvalidMesh in .ply and .vtp for a triangle with the same vertex at two corners, or if a vertex of no
/// triangle is not finite.
/// @throws FileError, also for .glb of more than 4 GiB.
/// @throws OutOfMemory, Cancelled.
void write_surface_map(const std::filesystem::path& path, const MeshView& mesh, const SurfaceMap& map,
                       const FileMetadata& metadata = {}, const SurfaceMapWriteOptions& options = {},
                       const Context& context = {});

/// Content of a file of a surface map.
struct SurfaceMapFile {
  TriangleMesh mesh;  ///< triangles only
  SurfaceMap map;     ///< all members except `phases` and `warnings`
  FileMetadata metadata;
};

/// Reads a .npz file of write_surface_map(). All numbers are those that were written, bit for bit. Types and shapes of
/// arrays and ranges of indices are checked. Charts must lie within the texture, and texels in or next to the chart of
/// their triangle. Sites are not checked, because the file does not contain the mesh of the sites.
/// @throws FormatError that states the reason.
/// @throws FileError, OutOfMemory.
/// Cost: about the time of reading the file. Memory is limited by the size of the content of the file.
[[nodiscard]] SurfaceMapFile read_surface_map(const std::filesystem::path& path);
/// Reads a surface map from memory. @param name  used as the name of the file in messages.
[[nodiscard]] SurfaceMapFile read_surface_map(std::span<const std::byte> bytes, const std::string& name);

/// Returns true if a file is an .npz file with the arrays of a surface map. Returns false if the file cannot be read.
[[nodiscard]] bool holds_surface_map(const std::filesystem::path& path);

/// Returns SurfaceMap::finite_range().
/// @throws InvalidMesh if the map lacks the atlas or values of texels.
[[nodiscard]] std::optional<std::pair<double, double>> finite_range(const SurfaceMap& map);

/// Returns true if some of the distances may be negative.
[[nodiscard]] bool is_signed(const SurfaceMap& map);

/// Returns the colour scale that write_surface_map() uses for distances.
/// @throws InvalidOption for an invalid range.
[[nodiscard]] ColorScale color_scale_of(const SurfaceMap& map, const SurfaceMapWriteOptions& options = {});

/// Texture of colours in memory.
struct ColorTexture {
  std::uint32_t width = 0;           ///< texels
  std::uint32_t height = 0;          ///< texels
  std::vector<std::uint8_t> pixels;  ///< red, green, blue; rows from the top
  [[nodiscard]] PixelView view() const { return {pixels, width, height, PngChannels::rgb}; }
};
/// Returns the texture of a map in colours, as in the files of write_surface_map().
/// @throws InvalidMesh if the map lacks the atlas or values of texels.
/// @throws OutOfMemory, Cancelled.
/// Cost: about 15 ns per texel.
[[nodiscard]] ColorTexture color_texture(const SurfaceMap& map, const ColorScale& scale, const Context& context = {});

}  // namespace blum
