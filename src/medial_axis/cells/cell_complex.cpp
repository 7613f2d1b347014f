
#include <algorithm>
#include <utility>

#include "medial_axis/cells/cell_complex.hpp"

#include "blum/core/parallel.hpp"

namespace blum::detail {
namespace {

using Pair = std::array<Cell, 2>;

/// Returns rows of indices. Row r contains, in ascending order, the second items of all pairs whose first item is r.
IndexRows rows_of(std::vector<Pair> pairs, std::size_t rows) {
  std::sort(pairs.begin(), pairs.end());
  std::vector<std::size_t> first(rows + 1, 0);
  std::vector<std::uint32_t> items;
  items.reserve(pairs.size());
  for (const auto& [row, item] : pairs) {
    ++first[row + std::size_t{1}];
    items.push_back(item);
  }
  for (std::size_t r = 0; r < rows; ++r) first[r + 1] += first[r];
  return {std::move(first), std::move(items)};
}

/// Returns bits: bit a is set if the cell that spans axes `a` from a node (i, j, k) belongs to a given voxel. Bit x + 2
/// y + 4 z of `voxels` is the voxel at (i - 1 + x, j - 1 + y, k - 1 + z).
std::uint8_t cells_at(unsigned voxels) {
  std::uint8_t cells = 0;
  for (CellAxes axes = 0; axes < 8; ++axes) {
    // A voxel contains the cell if it is on the upper side of the node along all axes that the cell spans.
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

ExtraIncidence::ExtraIncidence(BodyCells cells)
    : first_(cells.first),
      cells_(std::move(cells.extra)),
      faces_(std::move(cells.faces)),
      mixed_(cells.lattice),
      replaced_(std::move(cells.replaced)) {
  std::vector<Pair> cofaces;        // cofaces of extra cells
  std::vector<Pair> extra_cofaces;  // extra cofaces of lattice cells
  std::vector<Pair> extra_faces;
  for (std::uint32_t k = 0; k < cells_.size(); ++k) {
    for (const Cell face : faces_[k]) {
      if (face >= first_) {
        cofaces.push_back({face - first_, first_ + k});
      } else {
        extra_cofaces.push_back({face, first_ + k});
      }
    }
  }
  for (const auto& [extra, plain] : cells.cofaces) {
    cofaces.push_back({extra, plain});
    extra_faces.push_back({plain, first_ + extra});
  }
  cofaces_ = rows_of(std::move(cofaces), cells_.size());
  for (const auto* pairs : {&extra_cofaces, &extra_faces}) {
    for (const Pair& pair : *pairs) mixed_.insert(pair[0]);
  }
  mixed_.finish();
  for (auto* pairs : {&extra_cofaces, &extra_faces}) {
    for (Pair& pair : *pairs) pair[0] = mixed_.number(pair[0]);
  }
  cofaces_of_mixed_ = rows_of(std::move(extra_cofaces), mixed_.size());
  faces_of_mixed_ = rows_of(std::move(extra_faces), mixed_.size());
}

CellComplex::CellComplex(const VoxelSet& voxels, const Context& context) : CellComplex(voxels, nullptr, context) {}

CellComplex::CellComplex(const VoxelSet& voxels, std::shared_ptr<const ExtraIncidence> extra, const Context& context)
    : CellComplex(voxels, CellStructure(CellLattice(voxels.size()), std::move(extra)), context) {
  std::fill(extra_.begin(), extra_.end(), std::uint8_t{1});
}

CellComplex::CellComplex(const VoxelSet& voxels, CellStructure structure, const Context& context)
    : structure_(std::move(structure)), cells_(structure_.lattice().node_count()), extra_(structure_.extra_count(), 0) {
  static const std::array<std::uint8_t, 256> table = make_cell_table();
  const CellLattice& lattice = structure_.lattice();
  const auto& size = lattice.size();
  parallel_for(context, static_cast<std::size_t>(size[2]), 1, "", [&](const WorkRange& range) {
    for (auto k = static_cast<std::int64_t>(range.begin); k < static_cast<std::int64_t>(range.end); ++k) {
      for (std::int64_t j = 0; j < size[1]; ++j) {
        unsigned around = 0;
        for (std::int64_t i = 0; i < size[0]; ++i) {
          // Voxels on the upper side of the previous node are on the lower side of this node.
          around = around >> 1U & 0x55U;
          for (unsigned v = 0; v < 4; ++v) {
            const auto y = static_cast<std::int64_t>(v & 1U);
            const auto z = static_cast<std::int64_t>(v >> 1U);
            if (voxels.contains(i, j - 1 + y, k - 1 + z)) around |= 2U << (2 * v);
          }
          cells_[lattice.node(i, j, k)] = table[around];
        }
      }
    }
  });
  if (structure_.extra() == nullptr) return;
  for (const Cell cell : structure_.extra()->replaced()) {
    cells_[node_of(cell)] &= static_cast<std::uint8_t>(~(1U << axes_of(cell)));
  }
}

void CellComplex::insert_closure(Cell cell) {
  if (structure_.is_extra(cell)) {
    extra_[cell - structure_.first_extra()] = 1;
  } else {
    cells_[node_of(cell)] |= static_cast<std::uint8_t>(1U << axes_of(cell));
  }
  structure_.for_each_face(cell, [&](Cell face) {
    if (structure_.extra() == nullptr || !structure_.extra()->is_replaced(face)) insert_closure(face);
  });
}

}  // namespace blum::detail
