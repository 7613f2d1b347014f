// Blum: polygons with holes, and their triangulation. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/ear_clipping.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// A polygon with holes: a list of loops, each of consecutive points. The outline comes first, counter-clockwise. The
/// holes follow, clockwise.
struct PlanePolygon {
  using Point = std::array<double, 2>;

  std::vector<Point> points;
  std::vector<std::uint32_t> loop_starts;  ///< index of the first point of each loop; 0 for the outline

  /// Adds the outline or a hole. A loop in the wrong direction is reversed.
  /// @return false if the loop was reversed.
  bool add_loop(std::span<const Point> loop);
  [[nodiscard]] std::uint32_t loop_end(std::size_t loop) const {
    return loop + 1 < loop_starts.size() ? loop_starts[loop + 1] : static_cast<std::uint32_t>(points.size());
  }
};

/// Returns twice the area of a loop. The result is positive if the loop runs counter-clockwise.
[[nodiscard]] double doubled_area(std::span<const PlanePolygon::Point> loop);

/// Returns true if the segments ab and cd cross or overlap, or if an end of one segment lies inside the other segment.
/// Returns false if the segments only have a common end. The result is exact for the given points.
[[nodiscard]] bool segments_meet(const PlanePolygon::Point& a, const PlanePolygon::Point& b,
                                 const PlanePolygon::Point& c, const PlanePolygon::Point& d);

/// Triangulates a polygon by cutting off ears, after its holes are joined to the outline. Triangles are
/// counter-clockwise. Every edge of a loop is an edge of exactly one triangle, and no point is added.
/// @return  nullopt if a hole is not inside the outline, or loops cross.
/// @throws Cancelled. Cost: O(n^2) for n points, in practice.
[[nodiscard]] std::optional<std::vector<Triangle>> triangulate(const PlanePolygon& polygon, EarOrder order,
                                                               const Context& context = {});

}  // namespace blum::detail
