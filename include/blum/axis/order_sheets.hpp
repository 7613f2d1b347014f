// Blum: numbers of sheets that do not hang on the grid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "blum/axis/patch_numbers.hpp"
#include "blum/complex/complex.hpp"

namespace blum::detail {

/// Numbers the sheets of a medial axis anew, after label_sheets(), so that the same sheet of the same part has the same
/// number wherever the part lies and however fine the grid is:
/// - by the pair of patches (see PatchNumbers) that a sheet lies between, the smaller one first; of several pairs that
///   have a good part of its area, by the smallest;
/// - of one pair, by how far their centroids are from the first vertex of the mesh; where that is the same but for what
///   a grid changes, by how far they are from another vertex; at last, the larger one first.
/// Sheets with less than a thousandth of the area come after all others, in the same order. Without patches, numbers
/// stay.
void order_sheets(Complex& axis, const PatchNumbers& patches);

/// The same for a part of an axis, in the order that its sheets had there: of several that are one now, by the smallest
/// number of those that have a good part of its area.
/// @param before  of each triangle: its sheet before.
void order_sheets_as(Complex& axis, std::span<const std::int32_t> before);

}  // namespace blum::detail
