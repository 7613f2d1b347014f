// Blum: binary glTF files (.glb). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Numbers of vertices. Programs find them as `_NAME`.
struct GltfAttribute {
  std::string name;            ///< Letters, digits, `_`, `-` and `.`; without the `_` that files put before it.
  std::size_t components = 1;  ///< Numbers for each vertex, 1 to 4.
  /// Numbers, vertex after vertex. glTF has finite numbers only. Infinite numbers become the largest float,
  /// 3.4028235e38, with their sign, and NaN becomes 3.4028235e38.
  std::span<const float> values;
};

/// Texts (UTF-8) and finite numbers that a file holds as `extras` of the mesh.
using GltfExtras = std::vector<std::pair<std::string, std::variant<std::string, double, std::vector<double>>>>;

/// Content of a file: a mesh, with its texture. Nothing is copied or owned.
struct GltfMesh {
  std::string name = {};  ///< UTF-8; may be empty
  std::span<const Vec3d> vertices = {};
  std::span<const Triangle> triangles = {};
  std::span<const std::array<std::uint32_t, 2>> segments = {};  ///< Drawn as lines.
  std::span<const std::uint32_t> points = {};                   ///< Vertices that are drawn as points.
  std::span<const Vec3f> normals = {};                          ///< For vertices, of any length but zero; may be empty.
  std::vector<GltfAttribute> attributes = {};                   ///< For vertices; their names differ.
  /// Texture coordinates of the corners of each triangle, or none: u to the right and v down, 0 to 1 within the
  /// texture. A vertex is written once for each of its texture coordinates; vertices of no triangle are left out.
  /// Segments and points must then be empty.
  std::span<const std::array<std::array<float, 2>, 3>> texture_coordinates = {};
  /// Bytes of a PNG file, or none. A texture needs texture coordinates. Its colours are drawn as they are, without
  /// light (KHR_materials_unlit). They are read bilinearly, without mipmaps, clamped at the borders.
  std::span<const std::byte> texture = {};
  GltfExtras extras = {};
};

/// Writes a binary glTF 2.0 file, which appears complete or not at all. The same input gives the same bytes.
///
/// Positions are in single precision. If the mesh is further from the origin than it is large, they are relative to the
/// middle of its box. The node's translation holds that middle in double precision. Axes and units stay as they are
/// (glTF's own are metres, with y up). Triangles are visible from both sides.
/// @throws InvalidMesh if a corner names a missing vertex, or a written position is not finite or beyond single
/// precision. Also for more than 2^31 - 1 vertices.
/// @throws InvalidOption for other input that is not as described above.
/// @throws FileError if the file would have more than 2^32 - 1 bytes, the limit of the format, or the system refuses.
/// @throws OutOfMemory, Cancelled.
/// Cost: linear; three times the file's size of memory.
void write_gltf(const std::filesystem::path& path, const GltfMesh& mesh, const Context& context = {});
/// Returns the bytes of such a file.
[[nodiscard]] std::vector<std::byte> encode_gltf(const GltfMesh& mesh, const Context& context = {});

}  // namespace blum
