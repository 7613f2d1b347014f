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

/// Place in a texture, in texels: x to the right, y down. Texel (i, j) is the square from (i, j) to (i + 1, j + 1). Its
/// middle is (i + 0.5, j + 0.5).
struct TexturePlace {
  double x = 0, y = 0;
  [[nodiscard]] friend constexpr bool operator==(const TexturePlace&, const TexturePlace&) = default;
};

/// Layout of the triangles of a mesh in a texture. It depends on the connectivity of the mesh. If made by
/// surface_atlas(), it also depends on the lengths of edges. It stays usable while the vertices move.
struct SurfaceAtlas {
  std::uint32_t width = 0;   ///< texels
  std::uint32_t height = 0;  ///< texels
  /// Places of the corners of each triangle.
  std::vector<std::array<TexturePlace, 3>> corners;
  /// Triangle whose values a texel holds; none() for texels of no triangle. Rows from the top, x fastest. A triangle
  /// has the texels that lookups within it read, by the nearest texel or bilinearly. If several triangles read a texel,
  /// it belongs to the one that its middle is furthest inside of, or nearest to.
  Buffer<TriangleId> triangle;
  /// True: no texel is read by two triangles. False: some may be; always false for given texture coordinates.
  bool is_separate = true;

  [[nodiscard]] std::size_t size() const { return triangle.size(); }
  /// Returns the texture coordinates of a triangle's corners, 0 to 1. As in glTF, u points right and v down; OBJ has 1
  /// - v.
  [[nodiscard]] std::array<std::array<float, 2>, 3> texture_coordinates(TriangleId of) const;
};

/// Makes an atlas with a chart of its own for each triangle: a right triangle, whose legs are the two shorter edges.
/// Each leg is as many texels long as its edge, rounded up. Two charts of similar size share a rectangle. No triangle
/// is mirrored, and any mesh with triangles has an atlas. (Legs are powers of two in Sud 2006, section 3.3.)
///
/// @param texel  side of a texel on the surface, mesh units, > 0. Along the two shorter edges of each triangle, texels
///               are at most that long.
/// @throws InvalidMesh, also without triangles.
/// @throws InvalidOption if the texture would have more than 16384 texels a side; the message names about the smallest
/// texel that fits.
/// @throws Cancelled.
/// Cost: O(triangles log triangles + texels).
[[nodiscard]] SurfaceAtlas surface_atlas(const MeshView& mesh, double texel, const Context& context = {});
/// Makes an atlas with about this many texels, including the gutters between charts. It has at least some for each
/// triangle.
[[nodiscard]] SurfaceAtlas surface_atlas_of_size(const MeshView& mesh, std::size_t texels, const Context& context = {});

/// Makes an atlas from the texture coordinates of a mesh.
/// @param coordinates    places in the texture, in texels. Those that no triangle uses may lie outside of it.
/// @param corners        for each triangle of the mesh, the indices of its corners' coordinates.
/// @param width, height  texels, 1 to 16384.
/// @throws InvalidMesh, also without triangles.
/// @throws InvalidOption for another size of the texture or count of corners, or an index out of range. Also if a used
/// coordinate is not finite or lies outside of the texture.
/// @throws InvalidOption if two triangles cover the middle of the same texel; the message names both.
/// @throws Cancelled.
[[nodiscard]] SurfaceAtlas surface_atlas_from(const MeshView& mesh, std::span<const TexturePlace> coordinates,
                                              std::span<const Triangle> corners, std::uint32_t width,
                                              std::uint32_t height, const Context& context = {});

/// Returns the point of the surface that a texel represents: the place of its middle in its triangle. If the middle
/// lies beyond the triangle's border, it is the closest point of the triangle.
/// @param texel  one that belongs to a triangle.
/// Cost: O(vertices); for many texels use surface_texels().
[[nodiscard]] Vec3d surface_point(const MeshView& mesh, const SurfaceAtlas& atlas, std::size_t texel);
/// Surface points of all texels that belong to a triangle, in rising order of texels.
struct SurfaceTexels {
  std::vector<std::uint32_t> texels;  ///< indices
  std::vector<Vec3d> points;          ///< on the surface, mesh units
};
/// Computes the surface points of all texels that belong to a triangle.
/// @throws InvalidMesh if mesh and atlas have different counts of triangles.
/// @throws Cancelled.
[[nodiscard]] SurfaceTexels surface_texels(const MeshView& mesh, const SurfaceAtlas& atlas,
                                           const Context& context = {});

/// Returns, for each triangle, a bound on how far its points are from the points whose values a lookup reads; mesh
/// units. For lookups of the nearest texel, it bounds the distance to the texel's point. For bilinear lookups, it
/// bounds the weighted mean of the distances to the points of the four nearest texels. The bound is half the diagonal
/// of a texel, stretched as the triangle is. It is larger if other triangles own some of these texels, and infinite if
/// the chart has no area.
/// @throws InvalidMesh if mesh and atlas have different counts of triangles.
/// @throws Cancelled.
[[nodiscard]] std::vector<double> texel_reaches(const MeshView& mesh, const SurfaceAtlas& atlas,
                                                const Context& context = {});

}  // namespace blum
