#include "medial_axis/shape/axis_corners.hpp"

#include <algorithm>
#include <utility>

#include "blum/core/parallel.hpp"

namespace blum::detail {
namespace {

constexpr std::size_t cells_per_range = 4096;

}  // namespace

AxisCorners::AxisCorners(const AxisPiece& piece, const Context& context)
    : piece_(piece),
      ranked_(piece.structure.lattice()),
      index_of_extra_(piece.structure.extra_count(), 0),
      vertex_place_(piece.cells.size(), 0) {
  const CellStructure& structure = piece.structure;
  const Cell first_extra = structure.first_extra();
  std::vector<std::size_t> first(piece.cells.size() + 1, 0);
  std::vector<std::size_t> first_side(piece.cells.size() + 1, 0);
  for (std::uint32_t c = 0; c < piece.cells.size(); ++c) {
    const AxisCell& own = piece.cells[c];
    if (structure.is_extra(own.cell)) {
      index_of_extra_[own.cell - first_extra] = c;
    } else {
      ranked_.insert(own.cell);
    }
    std::size_t count = static_cast<std::size_t>(own.dimension) + 1;
    if (own.dimension == 2) count = structure.is_extra(own.cell) ? structure.extra()->faces_of(own.cell).size() : 4;
    first[c + 1] = first[c] + count;
    first_side[c + 1] = first_side[c] + (own.dimension == 2 ? count : 0);
    if (own.dimension != 0) continue;
    vertex_place_[c] = static_cast<std::uint32_t>(vertex_cells_.size());
    vertex_cells_.push_back(own.cell);
  }
  ranked_.finish();
  std::vector<std::uint32_t> corners(first.back());
  std::vector<std::uint32_t> sides(first_side.back());
  parallel_for(context, piece.cells.size(), cells_per_range, "", [&](const WorkRange& range) {
    for (std::size_t c = range.begin; c < range.end; ++c) {
      const auto index = static_cast<std::uint32_t>(c);
      if (piece.cells[c].dimension == 0) corners[first[c]] = vertex_place_[c];
      if (piece.cells[c].dimension == 1) find_ends(index, &corners[first[c]]);
      if (piece.cells[c].dimension == 2) find_circle(index, &corners[first[c]], &sides[first_side[c]]);
    }
  });
  corners_ = IndexRows(std::move(first), std::move(corners));
  sides_ = IndexRows(std::move(first_side), std::move(sides));
}

std::uint32_t AxisCorners::index_of(Cell cell) const {
  if (piece_.structure.is_extra(cell)) return index_of_extra_[cell - piece_.structure.first_extra()];
  return ranked_.number(cell);
}

void AxisCorners::find_ends(std::uint32_t c, std::uint32_t* corners) const {
  std::size_t count = 0;
  piece_.structure.for_each_face(piece_.cells[c].cell, [&](Cell face) {
    if (!piece_.structure.is_extra(face) && !ranked_.contains(face)) return;
    if (count < 2) corners[count++] = vertex_place_[index_of(face)];
  });
}

void AxisCorners::find_circle(std::uint32_t c, std::uint32_t* corners, std::uint32_t* sides) const {
  constexpr std::size_t most_sides = 8;
  std::array<std::uint32_t, most_sides> edges{};
  std::array<std::array<std::uint32_t, 2>, most_sides> ends{};
  std::size_t count = 0;
  piece_.structure.for_each_face(piece_.cells[c].cell, [&](Cell face) {
    if (!piece_.structure.is_extra(face) && !ranked_.contains(face)) return;
    if (count == most_sides) return;
    edges[count] = index_of(face);
    find_ends(edges[count], ends[count].data());
    ++count;
  });
  std::uint32_t at = ends[0][0];
  for (std::size_t k = 0; k < count; ++k) {
    std::size_t next = k;
    while (next + 1 < count && ends[next][0] != at && ends[next][1] != at) ++next;
    std::swap(edges[k], edges[next]);
    std::swap(ends[k], ends[next]);
    corners[k] = at;
    sides[k] = edges[k];
    at = ends[k][0] == at ? ends[k][1] : ends[k][0];
  }
}

std::array<std::array<std::uint32_t, 3>, 2> triangles_of(std::span<const std::uint32_t> corners,
                                                         std::span<const AxisVertex> vertices) {
  const auto squared = [&](std::size_t a, std::size_t b) {
    return squared_length(vertices[corners[a]].position - vertices[corners[b]].position);
  };
  const std::size_t first = squared(0, 2) <= squared(1, 3) ? 0 : 1;
  const auto corner = [&](std::size_t k) { return corners[(first + k) % 4]; };
  return {{{corner(0), corner(1), corner(2)}, {corner(0), corner(2), corner(3)}}};
}

}  // namespace blum::detail
