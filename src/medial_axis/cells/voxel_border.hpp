// Blum: the cells in the border of a voxel. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "blum/grid/voxel_topology.hpp"

namespace blum::detail {

/// The border of a voxel has a place for each of its cells, x + 3 y + 9 z: along each axis 0 at the low side, 1 where
/// the cell spans it, 2 at the high side. Neighbours have the same places.
inline constexpr unsigned place_of_voxel = 13;

/// Along each axis, where a place lies: 0, 1, 2.
constexpr std::array<unsigned, 3> along_axes(unsigned place) {
  return {place % 3, place / 3 % 3, place / 9};
}

/// The place of the cell that spans `axes` from a corner (bits x, y, z: the high side).
constexpr unsigned place_on_border(unsigned corner, unsigned axes) {
  unsigned place = 0;
  for (unsigned a = 3; a-- > 0;) {
    const unsigned at = (axes >> a & 1U) != 0 ? 1 : 2 * (corner >> a & 1U);
    place = 3 * place + at;
  }
  return place;
}

/// For each place the neighbours that have the cell there, too.
inline constexpr std::array<Neighbourhood, 27> sharers_of_place = [] {
  std::array<Neighbourhood, 27> sharers{};
  for (unsigned p = 0; p < 27; ++p) {
    for (unsigned q = 0; q < 27; ++q) {
      bool shares = q != place_of_voxel;
      for (std::size_t a = 0; a < 3; ++a) {
        shares = shares && (along_axes(q)[a] == 1 || along_axes(q)[a] == along_axes(p)[a]);
      }
      if (shares) sharers[p] |= 1U << q;
    }
  }
  return sharers;
}();

}  // namespace blum::detail
