// Blum: balls along the edges and over the triangles of medial axes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/error.hpp"
#include "blum/core/vec3.hpp"

namespace blum {

/// Point of a medial axis with its radius. Between vertices, the radius is interpolated linearly.
struct AxisSample {
  Vec3d position;
  double radius = 0;         ///< Mesh units.
  std::uint32_t vertex = 0;  ///< Vertex at this point, or a corner of the edge or triangle that contains the point.
};

/// Returns the balls of an axis as samples. Vertices come first, in their order. Points on listed edges longer than
/// `step`, and on triangles with a side longer than `step`, come next. Each point of the axis has a sample within
/// `step`, unless an edge or side is longer than 4,096 steps. In decimated axes, interpolated radii are exact up to the
/// tolerance of the decimation.
/// @param step  > 0, mesh units.
/// @throws InvalidOption if the step is out of range.
/// Cost: linear in the number of samples. An edge has about length / step samples, and a triangle about area / step^2.
[[nodiscard]] std::vector<AxisSample> sample_axis(const MedialView& axis, double step);

/// Returns the area of all triangles, square mesh units.
[[nodiscard]] double area_of(const MedialView& axis);

}  // namespace blum
