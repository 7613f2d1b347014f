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

/// @param least_winding  number of what is inside.
/// @throws Unresolved where facets do not fit together, Cancelled.
[[nodiscard]] Boundary boundary_of_inside(const CrossedMesh& mesh, const CutMesh& cut, int least_winding,
                                          const Context& context);

}  // namespace blum::detail
