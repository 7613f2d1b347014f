// Blum: triangulation of polygons with holes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// A polygon with holes: the outline counter-clockwise, then the holes clockwise, each as a run of points.
struct Polygon {
  std::vector<std::array<double, 2>> points;
  std::vector<std::uint32_t> loop_starts;  ///< first point of each loop; the outline's is 0

  /// Adds a loop; turns it around where its direction is not the one above. @throws InvalidOption for fewer than three
  /// points, more than 20,000 in all, or no area.
  void add_loop(std::span<const std::array<double, 2>> loop);
  [[nodiscard]] std::uint32_t loop_end(std::size_t loop) const;
};

/// Counter-clockwise triangles over the polygon's points, by cutting off ears; holes are first joined to the outline.
/// Every edge of a loop is an edge of exactly one triangle, and no point is added.
/// @throws InvalidOption where loops cross or touch, or a hole is not inside the outline; Cancelled. Cost: O(n^2) for n
/// points, in practice.
[[nodiscard]] std::vector<Triangle> triangulate(const Polygon& polygon, const Context& context);

}  // namespace blum::detail
