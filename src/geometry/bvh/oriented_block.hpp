// Blum: blocks of eight oriented boxes and of eight triangles, and bounds on their distances from another box or
// triangle.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "blum/core/vec3.hpp"
#include "blum/geometry/rigid_transform.hpp"
#include "geometry/lanes.hpp"

namespace blum {

/// Box along three orthogonal axes.
struct OrientedBox {
  Vec3d center;
  std::array<Vec3d, 3> axes{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};  ///< unit vectors
  std::array<double, 3> half{};                                               ///< half-size along each axis

  [[nodiscard]] double half_sum() const { return half[0] + half[1] + half[2]; }
};

/// Returns the transformed box.
[[nodiscard]] inline OrientedBox placed(const OrientedBox& box, const RigidTransform& place) {
  return {place(box.center),
          {place.rotation * box.axes[0], place.rotation * box.axes[1], place.rotation * box.axes[2]},
          box.half};
}

struct alignas(64) OrientedBlock {
  double center[3][lanes];
  double axes[3][3][lanes];  ///< [axis][component][lane]
  double half[3][lanes];

  void set(std::size_t lane, const OrientedBox& box) {
    for (std::size_t k = 0; k < 3; ++k) {
      center[k][lane] = box.center[k];
      half[k][lane] = box.half[k];
      for (std::size_t x = 0; x < 3; ++x) axes[k][x][lane] = box.axes[k][x];
    }
  }
  [[nodiscard]] OrientedBox box(std::size_t lane) const {
    OrientedBox out;
    for (std::size_t k = 0; k < 3; ++k) {
      out.center[k] = center[k][lane];
      out.half[k] = half[k][lane];
      for (std::size_t x = 0; x < 3; ++x) out.axes[k][x] = axes[k][x][lane];
    }
    return out;
  }
};

/// Computes lower bounds of the squared distances between eight boxes and another box. Gaps are measured along the axes
/// of both boxes, and along the line through both centers. If no axis has a gap, the result is minus the square of the
/// smallest overlap along the axes of both boxes.
void squared_gaps(const OrientedBlock& block, const OrientedBox& box, double (&out)[lanes]);

/// Triangle and its unit normal. The normal is 0 if the triangle is too flat.
struct FlatTriangle {
  std::array<Vec3d, 3> corners;
  Vec3d normal;
};

/// Eight triangles with their normals.
struct alignas(64) FlatTriangleBlock {
  double corner[3][3][lanes];  ///< [corner][component][lane]
  double normal[3][lanes];

  void set(std::size_t lane, const std::array<Vec3d, 3>& corners) {
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k][0][lane] = corners[k].x;
      corner[k][1][lane] = corners[k].y;
      corner[k][2][lane] = corners[k].z;
    }
  }
  [[nodiscard]] FlatTriangle triangle(std::size_t lane) const {
    FlatTriangle out;
    for (std::size_t x = 0; x < 3; ++x) {
      for (std::size_t k = 0; k < 3; ++k) out.corners[k][x] = corner[k][x][lane];
      out.normal[x] = normal[x][lane];
    }
    return out;
  }
};

/// Common directions of a block of triangles.
struct BlockShape {
  Vec3d normal;  ///< sum of normals (of twice the area as length), all flipped to the side of the first normal
  Vec3d along;   ///< vector between the middles of the block's two halves, times 12
};

/// Sets the unit normals of triangles from their corners (0 for slivers), and the block's shape.
void set_normals(FlatTriangleBlock& block, BlockShape& out);

/// Computes the axis-aligned box around the corners.
void extent_along_axes(const FlatTriangleBlock& block, Box3& out);

/// Computes the interval along an axis that contains all corners.
void extent_along(const FlatTriangleBlock& block, const Vec3d& axis, double& low, double& high);

/// Computes lower bounds of the squared distances between eight triangles and another triangle. Gaps are measured along
/// the coordinate axes, along both normals, and along the line through both middles.
void squared_gaps(const FlatTriangleBlock& block, const FlatTriangle& triangle, double (&out)[lanes]);

/// Computes lower bounds of the squared distances between eight triangles and a box. Gaps are measured along the axes
/// of the box.
void squared_gaps(const FlatTriangleBlock& block, const OrientedBox& box, double (&out)[lanes]);

}  // namespace blum
