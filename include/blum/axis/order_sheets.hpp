// Blum: numbers of sheets that do not depend on the grid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "blum/axis/patch_numbers.hpp"
#include "blum/complex/complex.hpp"

namespace blum::detail {

/// Renumbers the sheets of a medial axis after label_sheets(). After that, the number of a sheet depends neither on the
/// position of the solid nor on the size of the grid's cells.
///
/// Sheets are sorted by three keys. The first key is the pair of patches (see PatchNumbers) on the two sides of the
/// sheet. If there are several pairs, the smallest pair is used. A pair is ignored if its area on the sheet is less
/// than 0.41 times the area of the pair with the largest area. The second key is the weighted sum of the distances of
/// the sheet's centroid from PatchNumbers::anchors(). The weights are the powers 0, 1, 2, ... of 0.618, the inverse
/// golden ratio. The third key is the former number of the sheet.
///
/// Sheets with less than a thousandth of the total area come after all others, sorted by the same keys. If `patches` is
/// empty, the numbers do not change.
void order_sheets(Complex& axis, const PatchNumbers& patches);

/// Renumbers the sheets of an axis that is part of a former axis, in the order of the former sheets. If a sheet
/// consists of several former sheets, their smallest number is used. A former sheet is ignored if its area in the new
/// sheet is less than 0.41 times the largest area of a former sheet.
/// @param before  former sheet of each triangle.
void order_sheets_as(Complex& axis, std::span<const std::int32_t> before);

}  // namespace blum::detail
