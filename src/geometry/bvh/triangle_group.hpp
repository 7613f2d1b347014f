// Blum: triangles in groups of eight, of which most pairs are ruled out in lanes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_contact.hpp"
#include "geometry/bvh/box_tree.hpp"
#include "geometry/lanes.hpp"

namespace blum {

/// Eight triangles a, b, c with their planes. Lanes that are not set have an empty box.
struct alignas(64) TriangleGroup {
  BoxBlock box;
  double point[3][3][lanes] = {};  ///< of each corner, axis by axis
  double corner[3][lanes] = {};    ///< numbers of the corners, which two triangles have in common where these are equal
  double normal[3][lanes] = {};    ///< (b - a) x (c - a)
  double magnitude[3][lanes] = {};  ///< of the products that are summed up to the normal

  TriangleGroup();

  /// Sets a lane; one without area is left as it is.
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

/// Whether all corners of a triangle that another one does not have lie for certain on one side of the other's plane:
/// then the two have nothing in common but common corners. False where the rounding leaves it open.
[[nodiscard]] bool is_beside(const GroupTriangle& triangle, const GroupTriangle& other);

/// The same for a plane through an edge of the other one, along the axis that its normal is closest to, and the side
/// where the rest of the other is not: this tells apart triangles in one plane.
[[nodiscard]] bool is_beyond_an_edge(const GroupTriangle& triangle, const GroupTriangle& other);

/// A bit for each triangle of a group that may have more in common with this one than corners: not those whose boxes do
/// not touch, nor those that lie for certain on one side of this one's plane but for common corners.
[[nodiscard]] unsigned may_meet(const TriangleGroup& group, const GroupTriangle& triangle);

}  // namespace blum
