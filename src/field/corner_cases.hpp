// Blum: how the surface of a heap of boxes passes a corner of the lattice. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace blum {

/// The eight voxels around a corner of the lattice; voxel o lies at (o & 1, o >> 1 & 1, o >> 2 & 1), low or high along
/// each axis. The surface has a patch for each 6-connected set of those that are not selected.
struct CornerCase {
  static constexpr std::uint8_t none = 255;

  std::uint8_t patches = 0;
  std::array<std::uint8_t, 8> patch_of{};           ///< of each voxel; none where it is selected
  std::array<std::array<std::int8_t, 3>, 8> way{};  ///< of each patch: the sum of its voxels' (+-1, +-1, +-1)
  /// Bit e: the edge from the corner up along axis e has two voxels selected, diagonally opposite of each other, and
  /// the other two not. The surface passes it twice.
  std::uint8_t double_edges = 0;
  /// Two voxels that are diagonally opposite of each other and nothing else: the patch is a ring around the corner.
  bool is_ring = false;
};

namespace detail {

constexpr bool is_in(unsigned set, unsigned voxel) {
  return (set >> voxel & 1U) != 0;
}

/// The voxels that are joined to the first one in a set.
constexpr unsigned flood(unsigned set, unsigned first) {
  unsigned found = 1U << first;
  for (unsigned step = 0; step < 8; ++step) {
    for (unsigned voxel = 0; voxel < 8; ++voxel) {
      for (unsigned axis = 0; axis < 3; ++axis) {
        if (is_in(found, voxel) && is_in(set, voxel ^ 1U << axis)) found |= 1U << (voxel ^ 1U << axis);
      }
    }
  }
  return found;
}

constexpr void add_patch(CornerCase& corner, unsigned voxels) {
  for (unsigned voxel = 0; voxel < 8; ++voxel) {
    if (!is_in(voxels, voxel)) continue;
    corner.patch_of[voxel] = corner.patches;
    for (unsigned axis = 0; axis < 3; ++axis) {
      std::int8_t& sum = corner.way[corner.patches][axis];
      sum = static_cast<std::int8_t>(sum + ((voxel >> axis & 1U) != 0 ? 1 : -1));
    }
  }
  ++corner.patches;
}

/// Whether the surface passes an edge twice; `edge` is its axis.
constexpr bool is_double(unsigned selected, unsigned edge) {
  const unsigned low = 1U << edge;  // the four voxels around have this bit
  const unsigned a = 1U << (edge + 1) % 3;
  const unsigned b = 1U << (edge + 2) % 3;
  const bool first = is_in(selected, low);
  const bool second = is_in(selected, low | a);
  return is_in(selected, low | a | b) == first && is_in(selected, low | b) == second && first != second;
}

constexpr CornerCase make_corner_case(unsigned selected) {
  CornerCase corner;
  corner.patch_of.fill(CornerCase::none);
  for (unsigned voxel = 0; voxel < 8; ++voxel) {
    if (is_in(selected, voxel) || corner.patch_of[voxel] != CornerCase::none) continue;
    add_patch(corner, flood(~selected & 0xffU, voxel));
  }
  for (unsigned edge = 0; edge < 3; ++edge) {
    if (is_double(selected, edge)) corner.double_edges = static_cast<std::uint8_t>(corner.double_edges | 1U << edge);
  }
  const auto first = static_cast<unsigned>(std::countr_zero(selected | 0x100U));
  corner.is_ring = first < 4 && selected == (1U << first | 1U << (7 - first));
  return corner;
}

constexpr std::array<CornerCase, 256> make_corner_cases() {
  std::array<CornerCase, 256> cases{};
  for (unsigned selected = 0; selected < 256; ++selected) cases[selected] = make_corner_case(selected);
  return cases;
}

}  // namespace detail

/// By which voxels are selected: bit o is voxel o.
inline constexpr std::array<CornerCase, 256> corner_cases = detail::make_corner_cases();

}  // namespace blum
