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
  /// Each point of either axis has one of the other that is no further away than this, mesh units; and radii that are
  /// interpolated linearly over triangles and edges differ by no more there. At most the tolerance.
  double deviation = 0;
  std::size_t vertices_before = 0;  ///< of the axis that vertices were taken out of
};

/// Takes vertices out of sheets, seams, rims and curves where what is left stays within a tolerance. Vertices that stay
/// keep their places and columns, and so their exact radii and footprints. Sheets stay within 0.8 of the tolerance,
/// rims, seams and curves within 0.4. Junctions, ends of curves, corners where seams meet rims, and the order of sheets
/// stay, and no two sheets become one. The homotopy type is kept: vertices go by contracting edges under the link
/// condition (see docs/theory/medial-axis.md).
///
/// Sheets move by less than half of the least radius nearby, so that none leaves its solid where vertices tell how deep
/// that is; certify() tells for sure.
/// @param axis       with the columns of MedialView, as MedialAxis::simplify() and prune_sheets() give it. An axis of
///                   all angles (MedialAxis::nested) is none: its edges overlap.
/// @param tolerance  >= 0, mesh units; a quarter of a voxel leaves what a voxel grid can tell. 0 takes away nothing.
/// @return           part of the vertices, in their order; edges and triangles in theirs.
/// @throws InvalidOption, also saying problem_of_medial() of what it has; Cancelled.
/// Cost: near-linear, about 3 us for each vertex; 120 bytes for each triangle. Threads do not change the result.
/// Method: edge contraction within strata, with a bound for the distance of the two surfaces over their common
/// refinement, summed over contractions (after Cohen, Manocha, Olano, "Simplifying polygonal models using successive
/// mappings", 1997).
[[nodiscard]] DecimatedAxis decimate(const Complex& axis, double tolerance, const Context& context = {});

}  // namespace blum
