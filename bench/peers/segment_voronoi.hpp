// Blum: 2D Voronoi diagrams of polygons by other programs. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/shapes/generators.hpp"
#include "support/measure.hpp"

namespace blum::bench {

/// An edge of the Voronoi diagram inside a polygon: between side k, from point k to the next one, numbered k, or point
/// k, numbered by the count of points and k.
struct SegmentVoronoiEdge {
  std::array<std::uint32_t, 2> sites{};  ///< the smaller one first
  double length = 0;                     ///< of its chord
};

struct PeerSegmentVoronoi {
  std::vector<SegmentVoronoiEdge> edges;  ///< inside the polygon
  Times times;                            ///< of the diagram, without looking at its edges
};

/// CGAL's Segment_Delaunay_graph_2 with filtered traits and without intersections; nullopt where it was not installed
/// when the benchmarks were configured. @param polygon  simple, counterclockwise.
[[nodiscard]] std::optional<PeerSegmentVoronoi> cgal_segment_voronoi(std::span<const Point2> polygon);

}  // namespace blum::bench
