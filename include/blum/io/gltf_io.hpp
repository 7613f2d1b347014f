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

/// Numbers of vertices, which programs find as `_NAME`.
struct GltfAttribute {
  std::string name;            ///< letters, digits, `_`, `-` and `.`; without the `_` that files put before it
  std::size_t components = 1;  ///< numbers for each vertex, 1 to 4
  /// Vertex after vertex. glTF has finite numbers only: files hold the largest float, 3.4028235e38, with its sign, for
  /// infinite ones, and 3.4028235e38 for what is not a number.
  std::span<const float> values;
};

/// What files say besides, as `extras` of the mesh: texts, which are UTF-8, and finite numbers.
using GltfExtras = std::vector<std::pair<std::string, std::variant<std::string, double, std::vector<double>>>>;

/// What a file shows: a mesh, with its texture. Nothing is copied or owned.
struct GltfMesh {
  std::string name = {};  ///< UTF-8; may be empty
  std::span<const Vec3d> vertices = {};
  std::span<const Triangle> triangles = {};
  std::span<const std::array<std::uint32_t, 2>> segments = {};  ///< drawn as lines
  std::span<const std::uint32_t> points = {};                   ///< vertices that are drawn as points
  std::span<const Vec3f> normals = {};                          ///< of vertices, of any length but zero; or none
  std::vector<GltfAttribute> attributes = {};                   ///< of vertices; their names differ
  /// Of the corners of each triangle, or none: u to the right and v down, 0 to 1 within the texture. Vertices are
  /// written once for each place that their corners have, without those of no triangle; there are no segments and
  /// points then.
  std::span<const std::array<std::array<float, 2>, 3>> texture_coordinates = {};
  /// The bytes of a PNG file, or none. Needs texture coordinates. Its colours are drawn as they are, without light
  /// (KHR_materials_unlit), read bilinearly, without mipmaps, clamped at the borders.
  std::span<const std::byte> texture = {};
  GltfExtras extras = {};
};

/// Writes a binary glTF 2.0 file, which appears complete or not at all. The same input gives the same bytes.
///
/// Positions are in single precision. Where the mesh is further from the origin than it is large, they count from the
/// middle of its box, which the node's translation holds in double precision. Axes and units stay as they are (glTF's
/// own are metres, with y up). Triangles are seen from both sides.
/// @throws InvalidMesh for corners that are no vertices, and positions to be written that are not finite or beyond
///         single precision; InvalidOption for the rest that is not as described above; FileError where the file would
///         have more than 2^32 - 1 bytes, which no such file can, or the system refuses; OutOfMemory, Cancelled.
///         Cost: linear; three times the file's size of memory.
void write_gltf(const std::filesystem::path& path, const GltfMesh& mesh, const Context& context = {});
/// The bytes of such a file.
[[nodiscard]] std::vector<std::byte> encode_gltf(const GltfMesh& mesh, const Context& context = {});

}  // namespace blum
