#include "field/cpu/point_cells.hpp"

#include <algorithm>

#include "field/cpu/record_geometry.hpp"

namespace blum::cpu {
namespace {

/// Largest number of points of a cell. More points would not stay in the caches. Smaller cells share too many
/// candidates with their neighbours; they are used only to give each thread some work.
constexpr std::size_t most_points = 16384;
constexpr std::size_t least_points = 1024;
constexpr std::size_t cells_per_thread = 8;

void add_cells(MortonOrder order, const PointCell& cell, std::size_t most, std::vector<PointCell>& out) {
  if (cell.size() == 0) return;
  if (cell.size() <= most) return out.push_back(cell);
  if (has_divisible_children(cell)) {
    for (const PointCell& child : children_of(order, cell)) add_cells(order, child, most, out);
    return;
  }
  PointCell part = cell;
  for (std::size_t begin = cell.begin; begin < cell.end; begin += most) {
    part.begin = begin;
    part.end = std::min(begin + most, cell.end);
    out.push_back(part);
  }
}

}  // namespace

std::array<PointCell, 8> children_of(MortonOrder order, const PointCell& cell) {
  std::array<PointCell, 8> out;
  const unsigned shift = 3 * (morton_levels - 1 - cell.level);
  const float half = cell.half / 2;
  std::size_t begin = cell.begin;
  for (std::uint32_t c = 0; c < 8; ++c) {
    const auto first = order.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = order.begin() + static_cast<std::ptrdiff_t>(cell.end);
    const auto is_in = [&](const detail::KeyedIndex& point) { return (point.key >> shift & 7U) <= c; };
    const auto end = static_cast<std::size_t>(std::partition_point(first, last, is_in) - order.begin());
    out[c] = {begin, end, cell.level + 1, cell.center, half};
    for (std::size_t axis = 0; axis < 3; ++axis) out[c].center[axis] += (c >> axis & 1U) != 0 ? half : -half;
    begin = end;
  }
  return out;
}

std::size_t most_per_cell(std::size_t points, int threads) {
  const std::size_t cells = threads > 1 ? cells_per_thread * static_cast<std::size_t>(threads) : 1;
  return std::clamp(points / cells, least_points, most_points);
}

std::vector<PointCell> point_cells(MortonOrder order, const PointCell& root, std::size_t most) {
  std::vector<PointCell> out;
  add_cells(order, root, most, out);
  return out;
}

}  // namespace blum::cpu
