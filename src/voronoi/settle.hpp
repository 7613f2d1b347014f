// Blum: points on walls, seams and junctions. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "blum/core/vec3.hpp"
#include "voronoi/label_geometry.hpp"

namespace blum::voronoi {

/// A box that points must stay in; flat along an axis where both coordinates are equal.
struct PlacedBox {
  Vec3d low, high;
};

/// A point near another one that is equally far from all of some labels, or on the surface of all of them, by
/// Gauss-Newton steps of least length. nullopt where there is none in the box that is near.
/// @param labels      one of each site, two or more; one does on the surface.
/// @param on_surface  whether the distance is 0.
/// @param start, box  relative to the centre of the labels.
[[nodiscard]] std::optional<Vec3d> settle(const LabelGeometry& geometry, std::span<const LabelIndex> labels,
                                          bool on_surface, const Vec3d& start, const PlacedBox& box);

}  // namespace blum::voronoi
