// Blum: extended sheets that share vertices where they meet. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "axis/rim_reach.hpp"
#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"

namespace blum::detail {

/// Sheets of a medial axis and the strips that extend them.
struct JoinedSheets {
  std::vector<Vec3d> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> first;  ///< For each triangle: its number before the sheets were joined.
  /// New vertex on an edge.
  struct OnEdge {
    std::array<std::uint32_t, 2> ends{};
    double part = 0;  ///< 0 at the first end, 1 at the second
  };
  std::vector<OnEdge> new_vertices;  ///< For each vertex that the input does not have, in their order.
  /// Edge of a strip, and the index of the border that it is a part of.
  struct Part {
    std::array<std::uint32_t, 2> ends{};
    std::uint32_t border = 0;
  };
  std::vector<Part> seams;     ///< Edges that the strip now shares with other sheets or strips.
  std::vector<Part> unshared;  ///< Edges that lie on other sheets at both ends, but share no edge with them.
};

/// Sheets and strips to join.
struct SheetsToJoin {
  const SearchMesh& mesh;
  std::size_t axis_vertices = 0;                      ///< The first vertices. Vertices that neither move nor disappear.
  std::vector<std::array<std::uint32_t, 2>> borders;  ///< Outer edges of strips. Each belongs to one triangle.
  /// For each vertex, mesh units. A strip meets another sheet if the strip's border passes the sheet within this
  /// distance.
  std::span<const double> tolerance;
};

/// Joins strips to the sheets and strips on which their borders lie. Triangles are divided where borders cross them.
/// After this division, each border is also a chain of edges of the other sheet. Vertices of borders move by at most
/// the tolerance. A sheet that meets a border at less than 15 degrees continues the strip, and is not joined to the
/// border.
/// Merged vertices belong to no triangle, but keep their numbers. New vertices follow the others.
/// @throws Cancelled.
/// Cost: about 10 microseconds per border edge and edge that borders cross.
[[nodiscard]] JoinedSheets join_sheets(const SheetsToJoin& sheets, const Context& context);

}  // namespace blum::detail
