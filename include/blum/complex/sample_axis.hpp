// Blum: balls along the edges and over the triangles of medial axes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "blum/complex/medial_columns.hpp"
#include "blum/core/error.hpp"
#include "blum/core/vec3.hpp"

namespace blum {

/// A point of a medial axis with a radius interpolated linearly between vertices.
struct AxisSample {
  Vec3d position;
  double radius = 0;         ///< mesh units
  std::uint32_t vertex = 0;  ///< itself, or a corner of the edge or triangle that it lies on
};

/// All vertices, in their order, and points of the listed edges and the triangles that are longer than a step, such
/// that no point of an axis is further than the step from a sample: the balls of an axis that few triangles hold. Radii
/// of decimated axes are then as exact as their tolerance.
/// @param step  > 0, mesh units.  @throws InvalidOption for another one.
/// Cost: linear in the samples, about (length / step) and (area / step^2) of them besides the vertices.
[[nodiscard]] std::vector<AxisSample> sample_axis(const MedialView& axis, double step);

/// The area of all triangles, square mesh units.
[[nodiscard]] double area_of(const MedialView& axis);

}  // namespace blum
