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

/// Numbers for each vertex. The file stores these numbers as the attribute `_NAME`.
struct GltfAttribute {
  std::string name;            ///< Letters, digits, `_`, `-` and `.`; without the `_` that is added in files.
  std::size_t components = 1;  ///< Numbers for each vertex, 1 to 4.
  /// Numbers of all vertices, in the order of the vertices. Infinite numbers and NaN are changed, because glTF allows
  /// finite numbers only. +-infinity becomes +-3.4028235e38 (the largest float), and NaN becomes 3.4028235e38.
  std::span<const float> values;
};

/// Texts (UTF-8) and finite numbers that a file holds as `extras` of the mesh.
using GltfExtras = std::vector<std::pair<std::string, std::variant<std::string, double, std::vector<double>>>>;

/// Content of a file: a mesh with its texture. Spans are not copied, and must outlive this object.
struct GltfMesh {
  std::string name = {};  ///< UTF-8; may be empty
  std::span<const Vec3d> vertices = {};
  std::span<const Triangle> triangles = {};
  std::span<const std::array<std::uint32_t, 2>> segments = {};  ///< Drawn as lines.
  std::span<const std::uint32_t> points = {};                   ///< Vertices that are drawn as points.
  std::span<const Vec3f> normals = {};         ///< One normal for each vertex, of any length except zero; may be empty.
  std::vector<GltfAttribute> attributes = {};  ///< Attributes of the vertices, with different names.
  /// Texture coordinates of the corners of each triangle; may be empty. Within the texture, u increases from 0 to 1 to
  /// the right, and v downwards. A vertex is written once for each of its different texture coordinates, and vertices
  /// of no triangle are left out. If there are texture coordinates, segments and points must be empty.
  std::span<const std::array<std::array<float, 2>, 3>> texture_coordinates = {};
  /// Bytes of a PNG file; may be empty. A texture requires texture coordinates. The colours of the texture are shown
  /// unchanged, without lighting (KHR_materials_unlit). Colours are interpolated bilinearly, without mipmaps, and
  /// clamped at the borders.
  std::span<const std::byte> texture = {};
  GltfExtras extras = {};
};

/// Writes a binary glTF 2.0 file, which appears complete or not at all. The same input gives the same bytes.
///
/// Positions are in single precision. If the distance of the mesh from the origin is larger than the mesh, positions
/// are relative to the middle of its box. In this case, the translation of the glTF node contains the middle of the box
/// in double precision. Axes and units are not converted (glTF expects metres, with y up). Triangles are visible from
/// both sides.
/// @throws InvalidMesh if a corner has the index of a missing vertex, or the mesh has more than 2^31 - 1 vertices.
/// InvalidMesh is also thrown if a written position is not finite or beyond single precision.
/// @throws InvalidOption if other members are not as described at GltfMesh and GltfAttribute.
/// @throws FileError if the file would have more than 2^32 - 1 bytes, the limit of the format, or the system reports an
/// error.
/// @throws OutOfMemory, Cancelled.
/// Cost: linear in the size of the input. Memory: three times the size of the file.
void write_gltf(const std::filesystem::path& path, const GltfMesh& mesh, const Context& context = {});
/// Returns the bytes of the file that write_gltf() writes.
[[nodiscard]] std::vector<std::byte> encode_gltf(const GltfMesh& mesh, const Context& context = {});

}  // namespace blum
