// Blum: points in the voids of a solid, which an axis may not be moved over. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "blum/geometry/triangle_mesh.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// A point deep in each void of a body: the deepest of the middles of some chords. The closed surface of an axis around
/// a void winds around this point. Its triangles may be moved across a corner of the void, as they cut corners anyway,
/// but not across the point: then the void would not be in it any more.
/// @param mesh     a closed surface that faces away from the body.
/// @param surface  the same.
/// @return         by rising x. Cost: linear in the mesh, and up to 32 chords for each void.
[[nodiscard]] std::vector<Vec3d> points_of_voids(const MeshView& mesh, const Surface& surface);

/// Whether a tetrahedron, its sides included, holds one of some points; false where it is flat. @param points  by
/// rising x.
[[nodiscard]] bool holds_any(std::span<const Vec3d> points, const std::array<Vec3d, 4>& tetrahedron);

/// Whether a triangle moves over one of some points, each corner along a line. Corners must be in the same order for
/// all triangles, so that those beside one another move over the same points along the edge between them.
/// @param points  by rising x.
[[nodiscard]] bool moves_over_any(std::span<const Vec3d> points, const std::array<Vec3d, 3>& from,
                                  const std::array<Vec3d, 3>& to);

}  // namespace blum::detail
