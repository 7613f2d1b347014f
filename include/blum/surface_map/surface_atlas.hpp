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

/// A place in a texture, in texels: x to the right, y down. Texel (i, j) is the square from (i, j) to (i + 1, j + 1);
/// its middle is (i + 0.5, j + 0.5).
struct TexturePlace {
  double x = 0, y = 0;
  [[nodiscard]] friend constexpr bool operator==(const TexturePlace&, const TexturePlace&) = default;
};

/// Lays the triangles of a mesh into a texture. It depends on how the mesh is connected and, where it is made by
/// surface_atlas(), on the lengths of its edges; it stays usable while the vertices move.
struct SurfaceAtlas {
  std::uint32_t width = 0;   ///< texels
  std::uint32_t height = 0;  ///< texels
  /// Where the corners of each triangle are.
  std::vector<std::array<TexturePlace, 3>> corners;
  /// The triangle whose values a texel holds, none() of texels that belong to no triangle; rows from the top, x
  /// fastest. A triangle has the texels that reading the texture within it looks at, by the nearest texel or
  /// bilinearly; where several look at a texel, the one that its middle is furthest inside of, or nearest to.
  Buffer<TriangleId> triangle;
  /// Whether that holds of all triangles: no texel is read by two. False of texture coordinates in which triangles
  /// meet.
  bool is_separate = true;

  [[nodiscard]] std::size_t size() const { return triangle.size(); }
  /// Corners of triangles as glTF and OBJ files have them: u to the right, 0 to 1; v down (glTF; OBJ has 1 - v).
  [[nodiscard]] std::array<std::array<float, 2>, 3> texture_coordinates(TriangleId of) const;
};

/// A chart of its own for each triangle: a right triangle, whose legs are the two shorter edges, as many texels long as
/// the edge is in texels, rounded up; two charts of like size share a rectangle. No triangle is turned over, and
/// anything that has triangles has an atlas (Sud 2006, section 3.3, has legs of powers of two).
///
/// @param texel  side of a texel on the surface, mesh units, > 0: along the two shorter edges of each triangle, texels
///               are at most that long.
/// @throws InvalidMesh, InvalidOption where the texture would have more than 16384 texels a side (naming the smallest
///         texel that has not), Cancelled. Cost: O(triangles log triangles + texels).
[[nodiscard]] SurfaceAtlas surface_atlas(const MeshView& mesh, double texel, const Context& context = {});
/// The same for about so many texels, those of the gutters between charts included (but at least some for each
/// triangle).
[[nodiscard]] SurfaceAtlas surface_atlas_of_size(const MeshView& mesh, std::size_t texels, const Context& context = {});

/// An atlas of texture coordinates that a mesh has.
/// @param coordinates    places in the texture, in texels; they may lie outside of it.
/// @param corners        for each triangle of the mesh, which of them its corners have.
/// @param width, height  texels, 1 to 16384.
/// @throws InvalidMesh, InvalidOption where the counts differ, an index is none, a coordinate is not finite, a triangle
///         leaves the texture, or two triangles cover the middle of the same texel (naming both); Cancelled.
[[nodiscard]] SurfaceAtlas surface_atlas_from(const MeshView& mesh, std::span<const TexturePlace> coordinates,
                                              std::span<const Triangle> corners, std::uint32_t width,
                                              std::uint32_t height, const Context& context = {});

/// The point of the surface that a texel stands for: where its middle lies in its triangle or, beyond the triangle's
/// border, the closest point of the triangle.
/// @param texel  one that belongs to a triangle. Cost: O(vertices); for many see surface_texels().
[[nodiscard]] Vec3d surface_point(const MeshView& mesh, const SurfaceAtlas& atlas, std::size_t texel);
/// Those of all texels that belong to a triangle, in rising order of texels.
struct SurfaceTexels {
  std::vector<std::uint32_t> texels;  ///< indices
  std::vector<Vec3d> points;          ///< of the surface, mesh units
};
/// @throws InvalidMesh where the mesh has another count of triangles than the atlas, Cancelled.
[[nodiscard]] SurfaceTexels surface_texels(const MeshView& mesh, const SurfaceAtlas& atlas,
                                           const Context& context = {});

/// For each triangle, how far its points can be from what is read for them: from the point that stands for the nearest
/// texel, or on average (weighted as bilinear reading weighs) from those of the four nearest ones; mesh units. Half the
/// diagonal of a texel, stretched as the triangle is, and more where other triangles have some of these texels.
/// Infinite where the chart has no area.
/// @throws InvalidMesh where the mesh has another count of triangles than the atlas, Cancelled.
[[nodiscard]] std::vector<double> texel_reaches(const MeshView& mesh, const SurfaceAtlas& atlas,
                                                const Context& context = {});

}  // namespace blum
