// Blum: medial axes simplified sheet by sheet. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"

namespace blum {

/// Removes whole sheets whose separation angle is at most theta, the smallest angle first. The angle of a sheet is the
/// largest one of its triangles. A sheet is removed only if elementary collapses from its rim consume it, so the
/// homotopy type is preserved. Sheets that others block are tried again after these are removed. Curves of at most
/// theta are removed from their free ends. MedialAxis::simplify() cuts sheets apart at theta; this function keeps or
/// removes each as a whole.
/// @param axis   result of simplify() at a small theta; its labels decide the sheets.
/// @param theta  degrees, 0 to 180.
/// @return       part of the axis with its columns (edges have only those of medial_columns), labelled anew. Sheets
///               keep their order. The result for a larger theta is part of that for a smaller one.
/// @throws InvalidOption if theta is out of range, or sheets or the angles of edges and triangles are missing. Also if
/// problem_of_medial() reports a problem in the columns that exist. Cancelled.
/// Cost: O(n log n), more if many sheets are tried in vain. Method: Sud 2006, 5.6.
[[nodiscard]] Complex prune_sheets(const Complex& axis, double theta, const Context& context = {});

}  // namespace blum
