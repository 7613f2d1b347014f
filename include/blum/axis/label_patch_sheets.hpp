// Blum: sheets of pairs of patches. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/error.hpp"

namespace blum {

/// Adds the column `patch_sheet` (int32) to the triangles of an axis: the number of a sheet between one pair of
/// patches. Triangles with the same patch on both sides get -1, because they belong to no sheet. Two other triangles
/// belong to one sheet if they have the same pair of patches and share an edge. No third triangle between two patches
/// may share this edge. Sheets are numbered in the order of their first triangles. An existing column `patch_sheet` is
/// replaced.
/// @param axis  with the columns `patch_a` and `patch_b` of add_patch_columns().
/// @throws InvalidOption if a column is missing; InvalidMesh with the text of problem_of(axis); Cancelled.
/// Cost: O(n log n) for n triangles, about 1 us per triangle.
void label_patch_sheets(Complex& axis, const Context& context = {});

}  // namespace blum
