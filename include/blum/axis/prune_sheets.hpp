// Blum: medial axes simplified sheet by sheet. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"

namespace blum {

/// Drops whole sheets whose separation angle, the largest of their triangles', is at most theta; the smallest first. A
/// sheet goes only where elementary collapses from its rim consume it, so that the homotopy type stays; sheets that
/// others kept from going are tried again when these are gone. Curves of at most theta go from their free ends. Where
/// MedialAxis::simplify() cuts sheets apart at theta, this keeps each as it is or drops it.
/// @param axis   as simplify() gives it, at a small theta: sheets are taken as they are labelled.
/// @param theta  degrees, 0 to 180.
/// @return       part of the axis with its columns (edges have those of medial_columns only), labelled anew with
/// sheets in the order that they had; what a larger theta leaves of the result is part of it.
/// @throws InvalidOption, also where it has no sheets or no angles of edges and triangles, or saying
/// problem_of_medial() of what it has; Cancelled.
/// Cost: O(n log n), more where many sheets are tried in vain. Method: Sud 2006, 5.6.
[[nodiscard]] Complex prune_sheets(const Complex& axis, double theta, const Context& context = {});

}  // namespace blum
