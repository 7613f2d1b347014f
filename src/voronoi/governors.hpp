// Blum: which labels may be closest in a box. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "blum/core/vec3.hpp"
#include "voronoi/label_geometry.hpp"

namespace blum::voronoi {

/// Of labels among which all are that are closest anywhere in the convex hull of some corners, those that are not ruled
/// out there: a label is where its domain lies outside of the hull, or where it is further away than one point of the
/// surface, the closest one to the middle. Less the square of the distance from a point, the square of that from a
/// plane, line or point is concave, so the corners tell. (Sud 2006, 5.4: governors of a cell.)
///
/// @param corners  relative to the centre of the labels, as `middle`, which lies between them.
/// Cost: O(labels x corners).
[[nodiscard]] std::vector<LabelIndex> governors(const LabelGeometry& labels, std::span<const LabelIndex> among,
                                                std::span<const Vec3d> corners, const Vec3d& middle);

/// The point of some triangles, edges and vertices that is closest to a point, each as a whole.
/// @param among  not empty.
[[nodiscard]] Vec3d closest_surface_point(const LabelGeometry& labels, std::span<const LabelIndex> among,
                                          const Vec3d& q);

}  // namespace blum::voronoi
