// Blum: where the edges of a mesh and a box meet. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "medial_axis/surface/surface.hpp"

namespace blum {

/// A part of a segment, and the axes of the sides of a box that cut it off; none where an end of the segment is left.
struct SegmentPart {
  double low = 0, high = 1;
  std::optional<std::size_t> low_axis, high_axis;

  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
};

/// The part of a segment in a box; nullopt where there is none.
[[nodiscard]] std::optional<SegmentPart> part_within(const Vec3d& a, const Vec3d& b, const Box3& box);

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
