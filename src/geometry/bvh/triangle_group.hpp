// Blum: triangles in groups of eight; most pairs are excluded lane by lane. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_contact.hpp"
#include "geometry/bvh/box_tree.hpp"
#include "geometry/lanes.hpp"

namespace blum {

/// Eight triangles a, b, c with their planes. Unset lanes have an empty box.
struct alignas(64) TriangleGroup {
  BoxBlock box;
  double point[3][3][lanes] = {};   ///< [corner][axis][lane]
  double corner[3][lanes] = {};     ///< numbers of the corners; equal numbers mean a common corner
  double normal[3][lanes] = {};     ///< (b - a) x (c - a)
  double magnitude[3][lanes] = {};  ///< sums of the magnitudes of the normal's products

  TriangleGroup();

  /// Sets a lane. A triangle without area leaves it unchanged.
  void set(std::size_t lane, const detail::ContactTriangle& triangle);
};

/// One lane of a group.
struct GroupTriangle {
  Box3 box;
  std::array<Vec3d, 3> points;
  std::array<double, 3> corners;
  Vec3d normal;
  Vec3d magnitude;

  GroupTriangle(const TriangleGroup& group, std::size_t lane);
  [[nodiscard]] bool has_corner(double number) const;
  [[nodiscard]] detail::ContactTriangle for_contact() const;
};

/// Returns true if all corners of `triangle` that `other` lacks certainly lie on one side of the other's plane. The two
/// then share only common corners. False if rounding leaves it open.
[[nodiscard]] bool is_beside(const GroupTriangle& triangle, const GroupTriangle& other);

/// Same test with a plane through an edge of `other`, parallel to the axis closest to its normal. The side tested is
/// the one without the rest of `other`. This separates coplanar triangles.
[[nodiscard]] bool is_beyond_an_edge(const GroupTriangle& triangle, const GroupTriangle& other);

/// Returns a bit for each triangle of a group that may share more than corners with `triangle`. Excludes triangles
/// whose boxes do not touch, and those that certainly lie on one side of its plane except for common corners.
[[nodiscard]] unsigned may_meet(const TriangleGroup& group, const GroupTriangle& triangle);

}  // namespace blum
