// Blum: textures over the triangles of a mesh. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/buffer.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/ids.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Position in a texture, in texels: x to the right, y down. Texel (i, j) is the square from (i, j) to (i + 1, j + 1).
/// The middle of the texel is (i + 0.5, j + 0.5).
struct TexturePlace {
  double x = 0, y = 0;
  [[nodiscard]] friend constexpr bool operator==(const TexturePlace&, const TexturePlace&) = default;
};

/// Layout of the triangles of a mesh in a texture. The layout depends on the connectivity of the mesh. A layout that
/// surface_atlas() makes also depends on the lengths of edges. The layout stays valid when the vertices move.
struct SurfaceAtlas {
  std::uint32_t width = 0;   ///< texels
  std::uint32_t height = 0;  ///< texels
  /// Positions in the texture of the corners of each triangle.
  std::vector<std::array<TexturePlace, 3>> corners;
  /// For each texel: the triangle that it belongs to, or none(). Texels are listed in rows from the top, x fastest. A
  /// texel belongs to a triangle if a lookup at a point of the triangle reads it, as the nearest texel or bilinearly.
  /// If lookups in several triangles read a texel, it belongs to the triangle in which the texel's middle lies deepest.
  /// If the middle lies in none of them, the texel belongs to the closest of these triangles.
  Buffer<TriangleId> triangle;
  /// True if lookups in two different triangles never read the same texel. Always false for atlases from given texture
  /// coordinates.
  bool is_separate = true;

  [[nodiscard]] std::size_t size() const { return triangle.size(); }
  /// Returns the texture coordinates of a triangle's corners, 0 to 1. As in glTF, u points right and v down; OBJ files
  /// have 1 - v in place of v.
  [[nodiscard]] std::array<std::array<float, 2>, 3> texture_coordinates(TriangleId of) const;
};

/// Makes an atlas with a separate chart for each triangle of the mesh. A chart is a right triangle, whose legs show the
/// two shorter edges of the mesh's triangle. The length of a leg is the length of the edge, rounded up to whole texels.
/// Two charts of similar size share a rectangle. No triangle is mirrored. The function works for any mesh with
/// triangles. (In Sud 2006, section 3.3, the lengths of legs are powers of two.)
///
/// @param texel  side of a texel on the surface, mesh units, > 0. Along the two shorter edges of each triangle, texels
///               are at most this long.
/// @throws InvalidMesh if validate(mesh) fails, or if the mesh has no triangles.
/// @throws InvalidOption if a side of the texture would have more than 16384 texels. The message gives approximately
/// the smallest `texel` that is possible.
/// @throws Cancelled.
/// Cost: O(triangles log triangles + texels).
[[nodiscard]] SurfaceAtlas surface_atlas(const MeshView& mesh, double texel, const Context& context = {});
/// Makes an atlas with about `texels` texels, including the gutters between charts. The atlas may be larger, because
/// each triangle needs some texels.
[[nodiscard]] SurfaceAtlas surface_atlas_of_size(const MeshView& mesh, std::size_t texels, const Context& context = {});

/// Makes an atlas from the texture coordinates of a mesh.
/// @param coordinates    positions in the texture, in texels. Positions that no triangle uses may lie outside the
///                       texture.
/// @param corners        for each triangle of the mesh: indices of its three corners in `coordinates`.
/// @param width, height  size of the texture in texels, each 1 to 16384.
/// @throws InvalidMesh, also if the mesh has no triangles.
/// @throws InvalidOption if a size or an index is out of range, or if `corners` does not have one entry per triangle.
/// InvalidOption is also thrown if a position that a triangle uses is not finite, or lies outside the texture.
/// @throws InvalidOption if two triangles cover the middle of the same texel; the message contains the indices of both
/// triangles.
/// @throws Cancelled.
[[nodiscard]] SurfaceAtlas surface_atlas_from(const MeshView& mesh, std::span<const TexturePlace> coordinates,
                                              std::span<const Triangle> corners, std::uint32_t width,
                                              std::uint32_t height, const Context& context = {});

/// Returns the point of the surface that a texel represents: the point that the middle of the texel shows. If the
/// middle lies outside the triangle's chart, the result is the closest point of the triangle.
/// @param texel  index of a texel that belongs to a triangle.
/// Cost: O(vertices); for many texels use surface_texels().
[[nodiscard]] Vec3d surface_point(const MeshView& mesh, const SurfaceAtlas& atlas, std::size_t texel);
/// Surface points of all texels that belong to a triangle, by ascending index of texels.
struct SurfaceTexels {
  std::vector<std::uint32_t> texels;  ///< indices
  std::vector<Vec3d> points;          ///< on the surface, mesh units
};
/// Computes the surface points of all texels that belong to a triangle.
/// @throws InvalidMesh if mesh and atlas have different counts of triangles.
/// @throws Cancelled.
[[nodiscard]] SurfaceTexels surface_texels(const MeshView& mesh, const SurfaceAtlas& atlas,
                                           const Context& context = {});

/// Returns an upper bound for each triangle, mesh units. A lookup at a point of the triangle reads one or four texels.
/// The bound applies to the distance from the point of the lookup to the surface points of the texels. For lookups of
/// the nearest texel, the bound applies to the distance to the texel's point. For bilinear lookups, the bound applies
/// to the weighted mean of the distances to the points of the four nearest texels. The bound is half the diagonal of a
/// texel, times the largest stretch from chart to triangle. The bound is larger if some of the texels belong to other
/// triangles, and infinite if the chart has no area.
/// @throws InvalidMesh if mesh and atlas have different counts of triangles.
/// @throws Cancelled.
[[nodiscard]] std::vector<double> texel_reaches(const MeshView& mesh, const SurfaceAtlas& atlas,
                                                const Context& context = {});

}  // namespace blum
