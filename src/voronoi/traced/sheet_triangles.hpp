// Blum: triangles of a sheet between its curves. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "voronoi/traced/wall_map.hpp"

namespace blum::voronoi {

/// A triangulated sheet. The first vertices are those of its boundary; the others lie inside.
struct SheetTriangles {
  std::vector<Vec3d> points;
  std::vector<WallMap::Point> plane;  ///< the same points by WallMap::to_plane()
  std::vector<Triangle> triangles;    ///< counterclockwise in the plane
};

/// Triangulates a sheet. Triangles are split until the middles of their edges, and their own middles, are close to the
/// sheet. The distances from its sites must also be close to the mean distances of the corners. Edges of the boundary
/// are not split.
/// @param loops  points of the boundary; the outer loop first.
/// @param chord  largest difference of these places and distances, > 0, mesh units.
/// @param longest  inner edges that are longer are split, > 0, mesh units.
/// @return nothing if the loops cross in the plane.
/// @throws Cancelled.
[[nodiscard]] std::optional<SheetTriangles> sheet_triangles(const WallMap& map,
                                                            const std::vector<std::vector<Vec3d>>& loops, double chord,
                                                            double longest, const Context& context);

/// Triangulates a sheet that is narrower than the chords of its boundary, so that these may cross in the plane.
/// Connects points on opposite sides at equal shares of their lengths. The points in `plane` are not those of the map.
/// @param loop  points of the boundary.
/// @param chord  mesh units.
/// @return nothing if the sheet is wider: its area is larger than half of its boundary's length times `chord`.
[[nodiscard]] std::optional<SheetTriangles> narrow_sheet_triangles(const WallMap& map, const std::vector<Vec3d>& loop,
                                                                   double chord, const Context& context);

}  // namespace blum::voronoi
