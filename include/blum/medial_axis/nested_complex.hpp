// Blum: medial axes of all angles theta in one complex. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "blum/medial_axis/medial_complex.hpp"

namespace blum {

/// An edge that has a role at some angles: where from <= theta < until. One that is a seam first, then a rim and at
/// last a curve is there three times.
struct NestedEdge {
  std::array<std::uint32_t, 2> vertices;
  float separation_angle = 0;  ///< degrees
  MedialRole role = MedialRole::curve;
  float from = 0;  ///< degrees
  float until = std::numeric_limits<float>::infinity();
};

struct NestedTriangle {
  std::array<std::uint32_t, 3> vertices;
  float separation_angle = 0;                            ///< degrees; 0 where only homotopy keeps the triangle
  float until = std::numeric_limits<float>::infinity();  ///< degrees: it is there where theta is less
  std::uint32_t sheet = 0;                               ///< at the least angle
};

/// The medial axes of one solid at all angles from `least_theta` to 180, as sets of points: to show, and to simplify
/// without computing anything again. At an angle, the triangles, curves and vertices that are there cover what
/// MedialAxis::extract gives for it. Vertices at the same place are one, and pieces without extent are left out, so
/// that its topology need not be that of the solid.
struct NestedComplex {
  double least_theta = 0;
  std::vector<MedialVertex> vertices;  ///< with their roles at the least angle
  std::vector<float> vertex_until;     ///< degrees, one per vertex: it is there where theta is less
  std::vector<NestedEdge> edges;
  std::vector<NestedTriangle> triangles;
  std::uint32_t sheet_count = 0;
};

}  // namespace blum
