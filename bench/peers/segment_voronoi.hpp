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

/// An edge of the Voronoi diagram inside a polygon, between two sites. Number k is the side from point k to the next
/// point. Number n + k is point k of n points.
struct SegmentVoronoiEdge {
  std::array<std::uint32_t, 2> sites{};  ///< the smaller one first
  double length = 0;                     ///< length of its chord
};

struct PeerSegmentVoronoi {
  std::vector<SegmentVoronoiEdge> edges;  ///< inside the polygon
  Times times;                            ///< of the diagram, without the evaluation of its edges
};

/// CGAL's Segment_Delaunay_graph_2 with filtered traits and without intersections; nullopt if CGAL was not installed
/// when the benchmarks were configured. @param polygon  simple, counterclockwise.
[[nodiscard]] std::optional<PeerSegmentVoronoi> cgal_segment_voronoi(std::span<const Point2> polygon);

}  // namespace blum::bench
