// Blum: sheets of pairs of patches. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"

namespace blum {

/// Adds the column `patch_sheet` (int32) to the triangles of an axis: sheets of pairs of patches. Triangles inside a
/// patch have no sheet: -1. Among the others, two triangles with the same pair of patches belong to one sheet if they
/// have an edge in common. No third triangle between patches may have this edge. Sheets are numbered in the order of
/// their first triangles. If the axis has this column, it is replaced.
/// @param axis  with the columns `patch_a` and `patch_b` of add_patch_columns().
/// @throws InvalidOption if a column is missing; InvalidMesh with the text of problem_of(axis); Cancelled.
/// Cost: O(n log n) for n triangles, about 1 us per triangle.
void label_patch_sheets(Complex& axis, const Context& context = {});

}  // namespace blum
