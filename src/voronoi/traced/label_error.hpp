// Blum: a bound on the error of regions. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "voronoi/traced/traced_sites.hpp"

namespace blum::voronoi {

/// A triangle of a wall between two sites.
struct WallTriangle {
  std::array<Vec3d, 3> corners;  ///< relative to TracedSites::origin()
  std::array<TracedSites::Index, 2> sites{};
};

/// Returns a bound on the error of walls. At each point of a triangle, the border is closer than the triangle's sites
/// by at most this bound.
///
/// Let A be the affine function on a triangle that equals the larger distance of its two sites at the corners. The
/// distance from a convex set is convex, so neither site is further away than A. For each triangle k of the border, a
/// tangent plane of d_k is a lower bound on d_k. The difference of this plane and A is least at a corner. Triangles are
/// divided until their bound is below `target`, or a few times. (docs/theory/voronoi.md, "Traced solids".)
/// @param border  the border of the solid.
/// @param table   its sites.
/// @param target  > 0, mesh units.
/// @throws Cancelled.
/// Cost: about 10 us per triangle.
[[nodiscard]] double label_error(const TracedSites& sites, const MeshView& border, const SiteTable& table,
                                 std::span<const WallTriangle> triangles, double target, const Context& context);

}  // namespace blum::voronoi
