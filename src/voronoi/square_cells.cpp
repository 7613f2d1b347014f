#include "voronoi/square_cells.hpp"

#include <algorithm>

#include "blum/core/union_find.hpp"

namespace blum::voronoi {
namespace {

/// Follows the border: events, runs and arcs.
void follow_border(const CellTree& tree, const GridSquare& square, SquareCells& out) {
  out.runs.push_back({});
  bool is_first = true;
  for (std::size_t side = 0; side < 4; ++side) {
    tree.visit_leaf_edges(square.edges[side], side >= 2, [&](CellId id, bool is_down) {
      const GridEdge& edge = tree.edges[id];
      const std::uint32_t count = edge.last_event - edge.first_event;
      if (is_first) out.runs[0].label = is_down ? edge.last : edge.first;
      is_first = false;
      for (std::uint32_t k = 0; k <= count; ++k) {
        const std::uint32_t arc = is_down ? count - k : k;
        out.arcs.push_back({{id, arc}, static_cast<std::uint32_t>(out.runs.size() - 1)});
        if (k == count) break;
        const std::uint32_t event = is_down ? edge.last_event - 1 - k : edge.first_event + k;
        out.events.push_back(event);
        out.runs.push_back({is_down ? tree.events[event].before : tree.events[event].after, 0, 0});
      }
    });
  }
  if (out.events.empty()) return;
  // The last run ends where the first begins.
  const auto last = static_cast<std::uint32_t>(out.runs.size() - 1);
  out.runs.pop_back();
  for (SquareCells::ArcOfRun& arc : out.arcs) {
    if (arc.run == last) arc.run = 0;
  }
}

/// Numbers the components that the surface cuts the square into: each of its arcs leads from one to another and, where
/// it ends, back.
void find_bodies(const GridSquare& square, SquareCells& out) {
  std::vector<std::uint32_t> partner(out.events.size(), outside);
  for (const auto& [a, b] : square.chains) {
    const auto at_a = std::find(out.events.begin(), out.events.end(), a) - out.events.begin();
    const auto at_b = std::find(out.events.begin(), out.events.end(), b) - out.events.begin();
    partner[static_cast<std::size_t>(at_a)] = static_cast<std::uint32_t>(at_b);
    partner[static_cast<std::size_t>(at_b)] = static_cast<std::uint32_t>(at_a);
  }
  std::vector<std::uint32_t> open{0};
  std::uint32_t count = 1;
  for (std::size_t k = 0; k < out.runs.size(); ++k) {
    out.runs[k].body = open.back();
    if (k >= out.events.size() || partner[k] == outside) continue;
    if (partner[k] > k) {
      open.push_back(count++);
    } else if (open.size() > 1) {
      open.pop_back();
    }
  }
  out.body_count = count;
}

}  // namespace

SquareCells square_cells(const CellTree& tree, const LabelGeometry& labels, const GridSquare& square) {
  SquareCells out;
  follow_border(tree, square, out);
  find_bodies(square, out);
  for (SquareCells::Run& run : out.runs) {
    const std::uint32_t site = labels.site_of(run.label);
    const auto same = [&](const SquareCells::Piece& piece) {
      return piece.site == site && (site != outside || piece.body == run.body);
    };
    const auto found = std::find_if(out.pieces.begin(), out.pieces.end(), same);
    run.piece = static_cast<std::uint32_t>(found - out.pieces.begin());
    if (found == out.pieces.end()) out.pieces.push_back({site, run.body});
  }
  const auto count = static_cast<std::uint32_t>(out.events.size());
  detail::UnionFind joined(count);
  std::vector<std::uint32_t> first(out.pieces.size(), outside);
  std::vector<std::uint32_t> last(out.pieces.size(), outside);
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t piece = out.runs[k].piece;
    if (first[piece] == outside) {
      first[piece] = k;
    } else {
      joined.join(last[piece], k - 1);  // the event behind the last run, and the one before this
    }
    last[piece] = k;
  }
  for (std::size_t piece = 0; piece < out.pieces.size() && count > 0; ++piece) {
    joined.join(last[piece], (first[piece] + count - 1) % count);
  }
  out.component.assign(count, 0);
  std::vector<std::uint32_t> number(count, outside);
  for (std::uint32_t k = 0; k < count; ++k) {
    std::uint32_t& of_set = number[joined.find(k)];
    if (of_set == outside) of_set = out.component_count++;
    out.component[k] = of_set;
  }
  return out;
}

}  // namespace blum::voronoi
