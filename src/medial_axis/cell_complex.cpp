#include "medial_axis/cell_complex.hpp"

#include "blum/core/parallel.hpp"

namespace blum {
namespace {

/// The cells at a lattice node, from the eight voxels around it: bit x + 2 y + 4 z of `voxels` is the voxel at
/// (i - 1 + x, j - 1 + y, k - 1 + z). A cell is there where a voxel around it is.
std::uint8_t cells_at(unsigned voxels) {
  std::uint8_t cells = 0;
  for (CellAxes axes = 0; axes < 8; ++axes) {
    // Along the axes that the cell spans, only the voxels ahead of the node touch it.
    for (unsigned v = 0; v < 8; ++v) {
      if ((voxels >> v & 1U) != 0 && (v & axes) == axes) cells |= static_cast<std::uint8_t>(1U << axes);
    }
  }
  return cells;
}

std::array<std::uint8_t, 256> make_cell_table() {
  std::array<std::uint8_t, 256> table{};
  for (unsigned v = 0; v < 256; ++v) table[v] = cells_at(v);
  return table;
}

}  // namespace

CellComplex::CellComplex(const VoxelSet& voxels, const Context& context)
    : lattice_(voxels.size()), cells_(lattice_.node_count()) {
  static const std::array<std::uint8_t, 256> table = make_cell_table();
  const auto& size = lattice_.size();
  parallel_for(context, static_cast<std::size_t>(size[2]), 1, "", [&](const WorkRange& range) {
    for (auto k = static_cast<std::int64_t>(range.begin); k < static_cast<std::int64_t>(range.end); ++k) {
      for (std::int64_t j = 0; j < size[1]; ++j) {
        unsigned around = 0;
        for (std::int64_t i = 0; i < size[0]; ++i) {
          around = around >> 1U & 0x55U;  // what lay ahead lies behind now
          for (unsigned v = 0; v < 4; ++v) {
            const auto y = static_cast<std::int64_t>(v & 1U);
            const auto z = static_cast<std::int64_t>(v >> 1U);
            if (voxels.contains(i, j - 1 + y, k - 1 + z)) around |= 2U << (2 * v);
          }
          cells_[lattice_.node(i, j, k)] = table[around];
        }
      }
    }
  });
}

}  // namespace blum
