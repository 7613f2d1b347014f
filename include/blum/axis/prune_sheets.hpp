// Blum: medial axes simplified sheet by sheet. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"

namespace blum {

/// Removes whole sheets whose separation angle is at most theta. The sheet with the smallest angle is removed first.
/// The angle of a sheet is the largest angle of its triangles. A sheet is removed only if elementary collapses from its
/// rim remove all its triangles. Collapses preserve the homotopy type. If other sheets prevent the collapses of a
/// sheet, it is tried again after one of the other sheets was removed. Edges of curves are removed from free ends if
/// their angle is at most theta. MedialAxis::simplify() may remove a part of a sheet; this function keeps or removes
/// each sheet as a whole.
/// @param axis   result of simplify() at a small theta. Its column `sheet` decides which triangles form a sheet.
/// @param theta  degrees, 0 to 180.
/// @return       remaining part of the axis, with its columns; edges have only the columns of medial_columns. Roles and
///               sheets are labelled anew, and sheets keep their order. The result for a larger theta is part of the
///               result for a smaller theta.
/// @throws InvalidOption if theta is out of range, or sheets or the angles of edges and triangles are missing. The
/// function also throws InvalidOption if problem_of_medial() reports a problem in the columns that the axis has.
/// @throws Cancelled.
/// Cost: O(n log n) for n triangles, more if many sheets are tried in vain. Method: Sud 2006, 5.6.
[[nodiscard]] Complex prune_sheets(const Complex& axis, double theta, const Context& context = {});

}  // namespace blum
