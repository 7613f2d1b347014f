// Blum: medial axes with fewer triangles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>
#include <tuple>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/describe.hpp"
#include "blum/core/error.hpp"

namespace blum {

struct DecimatedAxis {
  Complex axis;
  /// Bound on the change, at most the tolerance, mesh units. Each point of either axis has a point of the other one
  /// within this distance. Radii, interpolated linearly over triangles and edges, also differ by at most this.
  double deviation = 0;
  std::size_t vertices_before = 0;  ///< Vertices of the axis before decimation.
};

/// Removes vertices from sheets, seams, rims and curves as long as the axis stays within a tolerance.
///
/// Remaining vertices keep their positions and columns, and so their exact radii and footprints. Sheets move by at most
/// 0.8 of the tolerance. Rims, seams and curves move by at most 0.4 of that, which is 0.32 of the tolerance. Junctions,
/// ends of curves, corners where seams meet rims, and the order of sheets are kept. No two sheets become one. The
/// homotopy type is preserved: vertices are removed by edge contractions under the link condition (see
/// docs/theory/medial-axis.md).
///
/// In each step a sheet reaches beyond its former place by at most half of the least radius nearby, or a millionth of
/// the tolerance. So it stays in the solid if radii at vertices bound the depth between them. certify() checks whether
/// it does.
/// @param axis       with the columns of MedialView, from MedialAxis::simplify() or prune_sheets(). Axes of all angles
///                   (MedialAxis::nested) are not accepted, because their edges overlap.
/// @param tolerance  >= 0, mesh units. A quarter of a voxel keeps the detail that a voxel grid can resolve. 0 removes
///                   nothing.
/// @return           part of the vertices, edges and triangles, in their order.
/// @throws InvalidOption if the tolerance is out of range, or with the text of problem_of_medial(); Cancelled.
/// Cost: near-linear, about 3 us per vertex and 120 bytes per triangle. The number of threads does not change the
/// result.
/// Method: edge contraction within strata. The distance of the two surfaces is bounded over their common refinement,
/// and the bounds are summed. (After Cohen, Manocha, Olano, "Simplifying polygonal models using successive mappings",
/// 1997.)
[[nodiscard]] DecimatedAxis decimate(const Complex& axis, double tolerance, const Context& context = {});

}  // namespace blum
