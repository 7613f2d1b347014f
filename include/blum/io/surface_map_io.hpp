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

/// How surface maps look in files, and what they say.
struct SurfaceMapWriteOptions {
  /// The distances at the ends of the colours of .png and .glb files, finite, the first less than the second. Unset:
  /// from 0, or from the smallest where the map is signed, to the largest that is finite.
  std::optional<std::pair<double, double>> range = {};
  /// Of distances, such as "mm", for the colour bar and the metadata; may be empty.
  std::string units = {};
};

/// Writes a surface map; the format goes by the extension. All but .png hold the triangles of the mesh; segments and
/// points have no texels and are left out.
///
///   .npz  everything: `distance` [h, w] and `vector` [h, w, 3] float32, `site` and `triangle` [h, w] int32 (-1: none),
///         rows from the top; `corners` [t, 3, 2] float64, places of the triangles' corners in texels (x right, y
///         down); `vertices` [n, 3] float64, `triangles` [t, 3] int32; `vertex_distance` [n] float64; `triangle_error`
///         (where there is one), `triangle_smallest`, `triangle_largest`, `triangle_mean` [t] float32; `metadata`, a
///         JSON object.
///   .png  the texture in colours, texel (i, j) as pixel (i, j), and beside it a bar with numbers and units.
///   .glb  binary glTF (see write_gltf()): the mesh with the texture in colours, its vertices once for each chart that
///         they are in; exact distances at vertices as the attribute `_DISTANCE`. Extras hold the metadata below,
///         `range` and `color_range` as two numbers each.
///   .ply, .vtp  the mesh with the exact distances at its vertices (column `distance`, float64), and of its triangles
///         `smallest`, `largest`, `mean` and, where there is one, `error` (float32); see write_complex().
///
/// Colours are those of ColorScale: sequential, or diverging where the map is signed; grey where there is nothing.
/// Texels of no triangle have the colour of the closest charts, four texels far, and are white beyond, so that no other
/// colour bleeds in.
/// @param metadata  goes before what is known of the map: `content` ("surface map"), `quantity`, `units`, `sign_rule`,
///                  `sign_reason`, `range` (the smallest and the largest distance of texels that is finite),
///                  `largest_error` and, in .npz files, `separate_charts` ("true" or "false"), texts each; a key that
///                  is given counts.
/// @throws InvalidOption for another extension, a range that is none, metadata with an empty key or one key twice, for
///         .npz metadata that give another quantity, sign rule or kind of charts than the map's;
///         InvalidMesh for a mesh that validate() refuses, a map that is not of this mesh or lacks parts, for .ply and
///         .vtp for a triangle that names a vertex twice or a vertex of no triangle that is not finite; FileError (for
///         .glb of more than 4 GiB, too), OutOfMemory, Cancelled.
void write_surface_map(const std::filesystem::path& path, const MeshView& mesh, const SurfaceMap& map,
                       const FileMetadata& metadata = {}, const SurfaceMapWriteOptions& options = {},
                       const Context& context = {});

/// A surface map as a file holds it.
struct SurfaceMapFile {
  TriangleMesh mesh;  ///< triangles only
  SurfaceMap map;     ///< all but `phases`
  FileMetadata metadata;
};

/// Reads what write_surface_map() writes to an .npz file: the same numbers, bit by bit. All of them are looked at:
/// types and shapes of arrays, indices in range, charts within the texture, texels beside the chart of their triangle.
/// Sites are not: which there are is known of the other mesh only.
/// @throws FormatError saying what is wrong, FileError, OutOfMemory. Cost: about that of reading the file; what it
///         takes of memory is bounded by what the file can hold.
[[nodiscard]] SurfaceMapFile read_surface_map(const std::filesystem::path& path);
/// @param name  what messages call the bytes.
[[nodiscard]] SurfaceMapFile read_surface_map(std::span<const std::byte> bytes, const std::string& name);

/// Whether a file is an .npz file with the arrays by which surface maps are told. False where it cannot be read.
[[nodiscard]] bool holds_surface_map(const std::filesystem::path& path);

/// The smallest and the largest finite distance of the texels that belong to triangles; nullopt where there is none.
[[nodiscard]] std::optional<std::pair<double, double>> finite_range(const SurfaceMap& map);

/// Whether some of the distances may be negative.
[[nodiscard]] bool is_signed(const SurfaceMap& map);

/// The colours that write_surface_map() gives to distances. @throws InvalidOption for a range that is none.
[[nodiscard]] ColorScale color_scale_of(const SurfaceMap& map, const SurfaceMapWriteOptions& options = {});

/// A texture in memory.
struct ColorTexture {
  std::uint32_t width = 0;           ///< texels
  std::uint32_t height = 0;          ///< texels
  std::vector<std::uint8_t> pixels;  ///< red, green, blue, rows from the top
  [[nodiscard]] PixelView view() const { return {pixels, width, height, PngChannels::rgb}; }
};
/// A map in colours, as write_surface_map() writes it. @throws InvalidMesh for a map that lacks parts, OutOfMemory,
/// Cancelled. Cost: about 15 ns per texel.
[[nodiscard]] ColorTexture color_texture(const SurfaceMap& map, const ColorScale& scale, const Context& context = {});

}  // namespace blum
