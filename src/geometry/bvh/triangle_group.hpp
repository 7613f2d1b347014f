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

/// Eight triangles with corners a, b, c, and their planes. Unset lanes have an empty box.
struct alignas(64) TriangleGroup {
  BoxBlock box;
  double point[3][3][lanes] = {};   ///< [corner][axis][lane]
  double corner[3][lanes] = {};     ///< numbers of the corners; equal numbers mean the same corner
  double normal[3][lanes] = {};     ///< (b - a) x (c - a)
  double magnitude[3][lanes] = {};  ///< per component of the normal: sum of the magnitudes of its products

  TriangleGroup();

  /// Sets a lane. Does nothing if the triangle has no area.
  void set(std::size_t lane, const detail::ContactTriangle& triangle);
};

/// One triangle in the form in which a group stores it.
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

/// Returns true if all corners of `triangle` that `other` lacks certainly lie on one side of the plane of `other`. The
/// two triangles then share only common corners. Returns false if rounding makes this uncertain.
[[nodiscard]] bool is_beside(const GroupTriangle& triangle, const GroupTriangle& other);

/// Does the test of is_beside() with another plane. This plane contains an edge of `other`, and is parallel to the
/// coordinate axis closest to the normal of `other`. The corners must be on the side opposite to the third corner of
/// `other`. Such planes separate coplanar triangles.
[[nodiscard]] bool is_beyond_an_edge(const GroupTriangle& triangle, const GroupTriangle& other);

/// Returns a bit for each triangle of a group that may share more than corners with `triangle`. The bit is 0 if the
/// bounding boxes do not touch. It is also 0 if the group's triangle, except for common corners, certainly lies on one
/// side of the plane of `triangle`.
[[nodiscard]] unsigned may_meet(const TriangleGroup& group, const GroupTriangle& triangle);

}  // namespace blum
