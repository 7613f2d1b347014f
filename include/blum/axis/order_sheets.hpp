// Blum: numbers of sheets that do not depend on the grid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "blum/axis/patch_numbers.hpp"
#include "blum/complex/complex.hpp"

namespace blum::detail {

/// Renumbers the sheets of a medial axis after label_sheets(). The same sheet of a part then has the same number,
/// wherever the part lies and however fine the grid is. Sheets are sorted by these keys:
/// - First the pair of patches (see PatchNumbers) on its two sides, the smaller pair first. If several pairs have a
///   good part of its area, the smallest counts.
/// - Then the sum of the distances of its centroid from PatchNumbers::anchors(). Their weights are powers of 0.618, the
///   inverse golden ratio.
/// - Then its former number.
///
/// Sheets with less than a thousandth of the area come after all others, in the same order. A good part is at least
/// 0.41 of the largest part. Without patches, numbers stay.
void order_sheets(Complex& axis, const PatchNumbers& patches);

/// Renumbers the sheets of a part of an axis in the order that they had in the axis. If a sheet consists of several
/// former ones, the smallest number of those with a good part of its area counts.
/// @param before  former sheet of each triangle.
void order_sheets_as(Complex& axis, std::span<const std::int32_t> before);

}  // namespace blum::detail
