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
  /// Upper bound on the change of the axis, mesh units; at most the tolerance. Each point of the axis before decimation
  /// has a point of the axis after decimation within this distance, and vice versa. Radii, interpolated linearly over
  /// triangles and edges, also change by at most this amount.
  double deviation = 0;
  std::size_t vertices_before = 0;  ///< Vertices of the axis before decimation.
};

/// Removes vertices from sheets, seams, rims and curves as long as the axis stays within a tolerance of its original
/// shape.
///
/// Remaining vertices keep their positions and columns, and so their exact radii and footprints. Sheets move by at most
/// 0.8 of the tolerance. Rims, seams and curves move by at most 0.32 of the tolerance. Junctions, ends of curves,
/// corners where seams meet rims, and the order of sheets are kept. Different sheets stay separate. Parts of a sheet
/// between different pairs of patches also stay separate. The homotopy type is preserved: vertices are removed by edge
/// contractions under the link condition (see docs/theory/medial-axis.md).
///
/// In thin parts, the tolerance may exceed the radius. So the total displacement of a sheet, seam, rim or curve is also
/// limited to 0.15 times the largest radius around it.
///
/// In each step, a sheet moves beyond its former shape by at most half of the smallest radius nearby. A move by a
/// millionth of the tolerance is always allowed. So the sheet stays in the solid, unless the solid between vertices is
/// thinner than the radii of the vertices indicate. The function certify() checks whether the axis stays in the solid.
/// @param axis       with the columns of MedialView, from MedialAxis::simplify() or prune_sheets(). Axes of all angles
///                   (MedialAxis::nested) are not accepted, because their edges overlap.
/// @param tolerance  >= 0, mesh units. A quarter of the side of a voxel keeps all detail that the voxel grid of the
///                   axis can resolve. With 0, no vertex is removed.
/// @return           the remaining vertices, edges and triangles, in their original order.
/// @throws InvalidOption if the tolerance is out of range, or if problem_of_medial() reports a problem; Cancelled.
/// Cost: near-linear, about 3 us per vertex and 120 bytes per triangle. The number of threads does not change the
/// result.
/// Method: contraction of edges within one sheet, rim, seam or curve. In each contraction, the distance between the old
/// and the new surface is bounded over their common refinement. The bounds of all contractions are summed. (After
/// Cohen, Manocha, Olano, "Simplifying polygonal models using successive mappings", 1997.)
[[nodiscard]] DecimatedAxis decimate(const Complex& axis, double tolerance, const Context& context = {});

}  // namespace blum
