#include "certificate/homology/generating_cycles.hpp"

#include <numeric>

namespace blum::verifier {
namespace {

constexpr std::size_t often = 65536;

/// Transposes a table: returns for each item the rows that contain it.
IndexRows turned(std::size_t items, std::span<const std::uint32_t> named, std::size_t per_row) {
  std::vector<std::size_t> first(items + 1, 0);
  for (const std::uint32_t item : named) ++first[item + std::size_t{1}];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> rows(named.size());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (std::size_t k = 0; k < named.size(); ++k) rows[next[named[k]]++] = static_cast<std::uint32_t>(k / per_row);
  return {std::move(first), std::move(rows)};
}

}  // namespace

GeneratingCycles::GeneratingCycles(const CellGraph& graph, const Context& context)
    : edges_(graph.edges),
      is_edge_left_(graph.edges.size(), true),
      is_cell_left_(graph.sides.size() / graph.per_cell, true),
      parent_edge_(graph.vertex_count, none),
      depth_(graph.vertex_count, none) {
  const IndexRows cells_of_edge = turned(edges_.size(), graph.sides, graph.per_cell);
  collapse(graph, cells_of_edge, context);
  grow_trees(graph, context);
  find_closing(graph, cells_of_edge, context);
}

void GeneratingCycles::collapse(const CellGraph& graph, const IndexRows& cells_of_edge, const Context& context) {
  std::vector<std::uint32_t> count(edges_.size());
  std::vector<std::uint32_t> line;  // free edges, first found first, so that the remaining graph has few detours
  for (std::uint32_t e = 0; e < count.size(); ++e) {
    count[e] = static_cast<std::uint32_t>(cells_of_edge[e].size());
    if (count[e] == 1) line.push_back(e);
  }
  for (std::size_t next = 0; next < line.size(); ++next) {
    if (next % often == 0) throw_if_cancelled(context);
    const std::uint32_t e = line[next];
    if (count[e] != 1) continue;
    is_edge_left_[e] = false;
    for (const std::uint32_t c : cells_of_edge[e]) {
      if (!is_cell_left_[c]) continue;
      is_cell_left_[c] = false;
      for (const std::uint32_t side : graph.sides.subspan(c * graph.per_cell, graph.per_cell)) {
        if (--count[side] == 1) line.push_back(side);
      }
    }
  }
}

void GeneratingCycles::grow_trees(const CellGraph& graph, const Context& context) {
  const std::span<const std::uint32_t> ends{edges_.empty() ? nullptr : edges_.front().data(), 2 * edges_.size()};
  const IndexRows edges_of_vertex = turned(graph.vertex_count, ends, 2);
  std::vector<std::uint32_t> line;
  line.reserve(graph.vertex_count);
  for (std::uint32_t root = 0; root < graph.vertex_count; ++root) {
    if (depth_[root] != none) continue;
    depth_[root] = 0;
    line.assign(1, root);
    for (std::size_t next = 0; next < line.size(); ++next) {
      if (next % often == 0) throw_if_cancelled(context);
      const std::uint32_t v = line[next];
      for (const std::uint32_t e : edges_of_vertex[v]) {
        const std::uint32_t other = edges_[e][0] == v ? edges_[e][1] : edges_[e][0];
        if (depth_[other] != none || !is_edge_left_[e]) continue;
        depth_[other] = depth_[v] + 1;
        parent_edge_[other] = e;
        line.push_back(other);
      }
    }
  }
}

void GeneratingCycles::find_closing(const CellGraph& graph, const IndexRows& cells_of_edge, const Context& context) {
  const std::size_t cells = is_cell_left_.size();
  std::vector<bool> is_open = is_edge_left_;  // neither in a tree, nor reducible, nor closing
  for (const std::uint32_t e : parent_edge_) {
    if (e != none) is_open[e] = false;
  }
  std::vector<std::uint8_t> open_sides(cells, 0);
  std::vector<std::uint32_t> one_open;
  for (std::uint32_t c = 0; c < cells; ++c) {
    if (!is_cell_left_[c]) continue;
    for (const std::uint32_t e : graph.sides.subspan(c * graph.per_cell, graph.per_cell)) open_sides[c] += is_open[e];
    if (open_sides[c] == 1) one_open.push_back(c);
  }
  const auto settle = [&](std::uint32_t e) {
    is_open[e] = false;
    for (const std::uint32_t c : cells_of_edge[e]) {
      if (!is_cell_left_[c]) continue;
      if (--open_sides[c] == 1) one_open.push_back(c);
    }
  };
  std::size_t steps = 0;
  for (std::uint32_t e = 0; e < edges_.size(); ++e) {
    while (!one_open.empty()) {
      if (++steps % often == 0) throw_if_cancelled(context);
      const std::uint32_t c = one_open.back();
      one_open.pop_back();
      if (open_sides[c] != 1) continue;
      for (const std::uint32_t side : graph.sides.subspan(c * graph.per_cell, graph.per_cell)) {
        if (!is_open[side]) continue;
        settle(side);
        break;
      }
    }
    if (!is_open[e]) continue;
    closing_.push_back(e);
    settle(e);
  }
}

}  // namespace blum::verifier
