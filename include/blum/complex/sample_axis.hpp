// Blum: balls along the edges and over the triangles of medial axes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/error.hpp"
#include "blum/core/vec3.hpp"

namespace blum {

/// Point of a medial axis with a radius, which is interpolated linearly between vertices.
struct AxisSample {
  Vec3d position;
  double radius = 0;         ///< Mesh units.
  std::uint32_t vertex = 0;  ///< The vertex itself, or a corner of its edge or triangle.
};

/// Returns the balls of an axis with long edges or large triangles. These are all vertices, in their order, then points
/// of listed edges and triangles that are longer than a step. No point of the axis is further than the step from a
/// sample, unless an edge or side is longer than 4,096 steps. Radii of decimated axes are as exact as their tolerance.
/// @param step  > 0, mesh units.
/// @throws InvalidOption if the step is out of range.
/// Cost: linear in the samples. Besides the vertices, these are about length / step for edges and area / step^2 for
/// triangles.
[[nodiscard]] std::vector<AxisSample> sample_axis(const MedialView& axis, double step);

/// Returns the area of all triangles, square mesh units.
[[nodiscard]] double area_of(const MedialView& axis);

}  // namespace blum
