#include "medial_axis/shape/near_extra.hpp"

#include <algorithm>
#include <array>

#include "blum/core/parallel.hpp"

namespace blum {
namespace {

bool is_special(const CellStructure& structure, Cell cell) {
  return structure.is_extra(cell) || structure.extra()->is_mixed(cell);
}

}  // namespace

NearExtra::NearExtra(const AxisPiece& piece, const AxisCorners& corners, const Witnesses& witnesses,
                     const Context& context)
    : is_near_(corners.vertex_cells().size(), 0), homes_(corners.vertex_cells().size()) {
  constexpr std::size_t vertices_per_range = 512;
  const CellStructure& structure = piece.structure;
  if (structure.extra() == nullptr) return;
  find_twins(piece, corners);
  const auto cells = corners.vertex_cells();
  parallel_for(context, cells.size(), vertices_per_range, "", [&](const WorkRange& range) {
    for (std::size_t v = range.begin; v < range.end; ++v) {
      bool is_near = is_special(structure, cells[v]);
      structure.for_each_coface(cells[v], [&](Cell edge) { is_near = is_near || is_special(structure, edge); });
      is_near_[v] = is_near ? 1 : 0;
      if (is_near) homes_[v] = witnesses.home_of(cells[v]);
    }
  });
}

bool NearExtra::has_twin(std::uint32_t edge) const {
  return std::binary_search(twins_.begin(), twins_.end(), edge);
}

void NearExtra::find_twins(const AxisPiece& piece, const AxisCorners& corners) {
  std::vector<std::array<std::uint32_t, 3>> edges;
  for (std::uint32_t c = 0; c < piece.cells.size(); ++c) {
    if (piece.cells[c].dimension != 1) continue;
    const auto ends = corners.of_cells()[c];
    const auto cells = corners.vertex_cells();
    if (!is_special(piece.structure, cells[ends[0]]) || !is_special(piece.structure, cells[ends[1]])) continue;
    edges.push_back({std::min(ends[0], ends[1]), std::max(ends[0], ends[1]), c});
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t e = 1; e < edges.size(); ++e) {
    if (edges[e][0] == edges[e - 1][0] && edges[e][1] == edges[e - 1][1]) twins_.push_back(edges[e][2]);
  }
  std::sort(twins_.begin(), twins_.end());
}

}  // namespace blum
