// Blum: points in the voids of a solid, over which an axis must not be moved. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "blum/geometry/triangle_mesh.hpp"
#include "medial_axis/surface/surface.hpp"

namespace blum::detail {

/// Returns a point deep in each void of a body: the deepest of the midpoints of up to 32 chords. The closed surface of
/// an axis around a void winds around this point. Triangles of an axis may move across a corner of the void, because
/// they cut corners anyway. If they moved across this point, the axis would no longer enclose the void.
/// @param mesh     a closed surface that faces away from the body.
/// @param surface  the same surface.
/// @return         points by ascending x; voids in which no point is found have none. Cost: linear in the size of the
/// mesh, and up to 32 chords for each void.
[[nodiscard]] std::vector<Vec3d> points_of_voids(const MeshView& mesh, const Surface& surface);

/// Returns true if a closed tetrahedron contains any of the points; false if the tetrahedron is flat.
/// @param points  by ascending x.
[[nodiscard]] bool holds_any(std::span<const Vec3d> points, const std::array<Vec3d, 4>& tetrahedron);

/// Returns true if a triangle moves over any of the points while each corner moves along a line. Adjacent triangles
/// must list their common corners in the same order. Then both move over the same volume along their common edge.
/// @param points  by ascending x.
[[nodiscard]] bool moves_over_any(std::span<const Vec3d> points, const std::array<Vec3d, 3>& from,
                                  const std::array<Vec3d, 3>& to);

}  // namespace blum::detail
