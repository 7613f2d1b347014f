// Blum: where the edges of a mesh and a box meet. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "medial_axis/surface.hpp"

namespace blum {

/// An edge between two triangles.
struct ClippedEdge {
  std::array<Vec3d, 2> ends;
  std::array<Vec3d, 2> outwards;  ///< unit normals of the triangles; zero where one has no area
};

/// Adds the middle of the part of an edge in a box, and where it goes through sides of this: there, `inwards` lies in
/// the side.
void add_clip_points(const ClippedEdge& edge, const Box3& box, std::vector<SurfacePoint>& points);

/// Adds where edges of a box go through a triangle: `inwards` is the direction of the edge that leads into the solid.
void add_clip_points(const std::array<Vec3d, 3>& triangle, const Vec3d& outwards, const Box3& box,
                     std::vector<SurfacePoint>& points);

}  // namespace blum
