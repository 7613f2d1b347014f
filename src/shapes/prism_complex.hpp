// Blum: solids glued from prisms and boxes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// A solid glued from boxes and triangular prisms whose faces match exactly where they meet: faces that two of them
/// share vanish, the rest is the boundary. Corners at equal coordinates are one vertex.
class PrismComplex {
 public:
  /// An axis-aligned box.
  void add_box(const Vec3d& lower, const Vec3d& upper);
  /// The prism between two triangles; `base` turns counter-clockwise seen from `top`, and so does top from beyond it.
  void add_prism(const std::array<Vec3d, 3>& base, const std::array<Vec3d, 3>& top);
  /// The closed boundary, facing outwards. Cost: O(n log n).
  [[nodiscard]] TriangleMesh boundary() const;

 private:
  struct Face {
    std::array<std::uint32_t, 4> key{};      ///< its corners, sorted
    std::array<std::uint32_t, 4> corners{};  ///< in order; a triangle names its last corner twice
  };
  std::uint32_t vertex(const Vec3d& p);
  void add_face(const std::array<std::uint32_t, 4>& corners);

  std::vector<Vec3d> vertices_;
  std::map<std::array<double, 3>, std::uint32_t> ids_;
  std::vector<Face> faces_;
};

/// Triangles of a rectangle with a round hole, counter-clockwise. Indices 0 to 3 are the rectangle's corners, starting
/// at the upper right, counter-clockwise; 4 to 3 + sides the hole's points, counter-clockwise, the first to the right
/// of the centre. `sides` is a multiple of 4. Each side of the rectangle is an edge of one triangle.
[[nodiscard]] std::vector<Triangle> triangulate_holed_rectangle(std::uint32_t sides);

}  // namespace blum::detail
