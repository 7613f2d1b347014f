#include "voronoi/square_cells.hpp"

#include <algorithm>
#include <utility>

#include "blum/core/union_find.hpp"

namespace blum::voronoi {
namespace {

/// Collects the events, runs and arcs along the border of a square.
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
        const LineEvent& at = tree.events[event];
        out.events.push_back(event);
        out.thin.push_back(at.has_several ? outside : at.thin);
        out.runs.push_back({is_down ? at.before : at.after, 0, 0});
      }
    });
  }
  if (out.events.empty()) return;
  // The last run and the first run are the same run.
  const auto last = static_cast<std::uint32_t>(out.runs.size() - 1);
  out.runs.pop_back();
  for (SquareCells::ArcOfRun& arc : out.arcs) {
    if (arc.run == last) arc.run = 0;
  }
}

/// Numbers the components into which the surface cuts the square. Along the border, an arc of the surface leads into
/// another component at its first end, and back at its second end.
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

EventComponents join_events(std::span<const std::uint32_t> region_of_run) {
  const auto count = static_cast<std::uint32_t>(region_of_run.size());
  EventComponents out;
  if (count == 0) return out;
  detail::UnionFind joined(count);
  const std::uint32_t regions = *std::max_element(region_of_run.begin(), region_of_run.end()) + 1;
  std::vector<std::uint32_t> first(regions, outside);
  std::vector<std::uint32_t> last(regions, outside);
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t region = region_of_run[k];
    if (first[region] == outside) {
      first[region] = k;
    } else {
      joined.join(last[region], k - 1);  // the event after the region's previous run, and the event before this run
    }
    last[region] = k;
  }
  for (std::uint32_t region = 0; region < regions; ++region) {
    if (first[region] != outside) joined.join(last[region], (first[region] + count - 1) % count);
  }
  out.of.assign(count, 0);
  std::vector<std::uint32_t> number(count, outside);
  for (std::uint32_t k = 0; k < count; ++k) {
    std::uint32_t& of_set = number[joined.find(k)];
    if (of_set == outside) of_set = out.count++;
    out.of[k] = of_set;
  }
  return out;
}

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
  std::vector<std::uint32_t> piece_of_run;
  for (std::size_t k = 0; k < out.events.size(); ++k) piece_of_run.push_back(out.runs[k].piece);
  EventComponents components = join_events(piece_of_run);
  out.component = std::move(components.of);
  out.component_count = components.count;
  return out;
}

}  // namespace blum::voronoi
