// Blum: what of facets bounds the points with some winding number or more. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/core/context.hpp"
#include "geometry/crossings/sheets.hpp"

namespace blum::detail {

/// The facets with at least some winding number behind them and less in front, as a mesh.
struct Boundary {
  std::vector<Triangle> triangles;  ///< names entries of `points`
  /// Several may be one point: where parts only touch, each has its own. Both are one but in the middle of edges
  /// between them that had to be cut for this.
  std::vector<std::array<PointId, 2>> points;
  std::vector<std::uint32_t> source_of;  ///< of each triangle, in the input
  std::size_t touching_edges = 0;        ///< edges along which parts only touch
};

struct WindingRule {
  int least = 1;  ///< winding number of what is inside
  /// Whether closed parts that are too thin for any ray to tell where they lie (1e-10 of the mesh's size) are left out,
  /// instead of being an error.
  bool leaves_out_thin_parts = false;
};

/// @throws Unresolved where facets do not fit together, Cancelled.
[[nodiscard]] Boundary boundary_of_inside(const CrossedMesh& mesh, const CutMesh& cut, const WindingRule& rule,
                                          const Context& context);

}  // namespace blum::detail
