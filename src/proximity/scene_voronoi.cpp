#include "proximity/scene_voronoi.hpp"

#include <algorithm>
#include <atomic>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/parallel.hpp"
#include "proximity/heaps.hpp"
#include "proximity/scene_primitives.hpp"
#include "proximity/voronoi_cells.hpp"

namespace blum::detail {
namespace {

constexpr std::size_t grain = 256;

/// Calls test(other) for the primitives that may be the closest one of a primitive, or within a distance, each once or
/// a few times.
template <class Test>
void for_each_candidate(const ScenePrimitives& primitives, const VoronoiCells& cells, std::uint32_t row,
                        double max_distance, bool is_closest, std::vector<std::uint32_t>& seen, const Test& test) {
  seen.clear();
  for (const std::uint32_t cell : cells.cells(row)) {
    double limit = max_distance + cells.radius();
    bool is_first = is_closest;
    for (const CellEntry& entry : cells.entries(cell)) {
      if (entry.distance > limit) break;
      if (!primitives.are_compared(row, entry.row)) continue;
      // The first one of these is the second closest at the middle of the cell, beside the primitive itself.
      if (is_first) limit = std::min(limit, entry.distance + 2 * cells.radius());
      is_first = false;
      seen.push_back(entry.row);
    }
  }
  std::sort(seen.begin(), seen.end());
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  for (const std::uint32_t other : seen) test(other);
}

/// The counts of parts of the work, added up.
void add_all(const std::vector<ProximityReport>& parts, const VoronoiCells& cells, ProximityReport& report) {
  report.culling = Culling::voronoi;
  report.cells += cells.size();
  report.left_over += cells.left_over();
  for (const ProximityReport& part : parts) add(part, report);
}

/// A distance that the closest pair is not further apart than: at the middle of a cell, that of a primitive and that of
/// the first one in the list that it is compared with, added.
double bound_of_cells(const ScenePrimitives& primitives, const VoronoiCells& cells, std::uint32_t rows,
                      double max_distance) {
  double bound = max_distance;
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (const std::uint32_t cell : cells.cells(row)) {
      const auto entries = cells.entries(cell);
      const auto own = std::find_if(entries.begin(), entries.end(), [&](const CellEntry& e) { return e.row == row; });
      if (own == entries.end()) continue;
      for (const CellEntry& other : entries) {
        const double sum = own->distance + other.distance + cells.rounding();
        if (sum >= bound) break;
        if (primitives.are_compared(row, other.row)) bound = sum;
      }
    }
  }
  return bound;
}

}  // namespace

std::optional<PrimitivePair> closest_pair_by_cells(const ObjectPair& pair, std::size_t objects, double cell_size,
                                                   double max_distance, const Context& context,
                                                   ProximityReport& report) {
  if (pair.is_self()) check_neighbours(pair);
  const ScenePrimitives primitives(std::span(&pair, 1), objects);
  const VoronoiCells cells(primitives, cell_size, max_distance, true, context);
  if (cells.left_over() > 0) {
    report.cells += cells.size();
    report.left_over += primitives.size();
    return closest_pair(pair, max_distance, context, report);
  }
  // Those of the first object come first.
  const auto rows = static_cast<std::uint32_t>(pair.a().primitives());
  const double bound = bound_of_cells(primitives, cells, rows, max_distance);
  struct Part {
    Closest best;
    ProximityReport report;
  };
  std::vector<Part> parts((rows + grain - 1) / grain);
  parallel_for(context, rows, grain, "separation", [&](const WorkRange& range) {
    Part& part = parts[range.begin / grain];
    part.best.limit = bound;
    std::vector<std::uint32_t> seen;
    for (auto row = static_cast<std::uint32_t>(range.begin); row < range.end; ++row) {
      const Box3 box = primitives.box(row);
      for_each_candidate(primitives, cells, row, part.best.limit, true, seen, [&](std::uint32_t other) {
        if (other < row) return;  // each pair once
        ++part.report.candidates;
        if (box_gap(box, primitives.box(other)) > part.best.limit) return;
        ++part.report.exact_tests;
        part.best.offer(primitives.compare(row, other));
      });
    }
  });
  Closest best{std::nullopt, bound};
  std::vector<ProximityReport> reports;
  for (const Part& part : parts) {
    if (part.best.pair) best.offer(*part.best.pair);
    reports.push_back(part.report);
  }
  add_all(reports, cells, report);
  return best.pair;
}

void closest_of_each_by_cells(std::span<const ObjectPair> pairs, std::size_t objects, double cell_size,
                              double max_distance, const Context& context, ProximityPairs& out) {
  const ScenePrimitives primitives(pairs, objects);
  PhaseTimer timer(out.report.phases);
  const VoronoiCells cells(primitives, cell_size, max_distance, true, context);
  timer.lap("diagram");
  std::vector<std::optional<PrimitivePair>> found(primitives.size());
  std::vector<ProximityReport> parts((found.size() + grain - 1) / grain);
  parallel_for(context, found.size(), grain, "closest primitives", [&](const WorkRange& range) {
    ProximityReport& report = parts[range.begin / grain];
    std::vector<std::uint32_t> seen;
    for (auto row = static_cast<std::uint32_t>(range.begin); row < range.end; ++row) {
      if (cells.is_left_over(row)) continue;
      Closest best{std::nullopt, max_distance};
      const Box3 box = primitives.box(row);
      for_each_candidate(primitives, cells, row, max_distance, true, seen, [&](std::uint32_t other) {
        ++report.candidates;
        if (box_gap(box, primitives.box(other)) > best.limit) return;
        ++report.exact_tests;
        best.offer(primitives.compare(row, other));
      });
      found[row] = best.pair;
    }
  });
  add_all(parts, cells, out.report);
  if (out.report.left_over > 0) {
    const auto is_wanted = [&](ObjectId object, std::uint32_t primitive) {
      return cells.is_left_over(primitives.row(object, primitive));
    };
    const ClosestRows rest = closest_rows(pairs, objects, max_distance, is_wanted, context, out.report);
    for (std::uint32_t row = 0; row < found.size(); ++row) {
      const Member& member = primitives.member(row);
      if (cells.is_left_over(row)) found[row] = rest[member.object.value][member.primitive];
    }
  }
  for (const auto& one : found) {
    if (one) out.pairs.push_back(*one);
  }
  timer.lap("exact tests");
}

void near_pairs_by_cells(std::span<const ObjectPair> pairs, std::size_t objects, double cell_size, double distance,
                         const Context& context, ProximityPairs& out) {
  const ScenePrimitives primitives(pairs, objects);
  PhaseTimer timer(out.report.phases);
  const VoronoiCells cells(primitives, cell_size, distance, false, context);
  timer.lap("diagram");
  if (cells.left_over() > 0) {
    // Pairs of these with all others are asked for: the hierarchy finds the rest by the way.
    near_pairs(pairs, distance, Neighbours::left_out, context, out);
    out.report.left_over = primitives.size();
    timer.lap("exact tests");
    return;
  }
  struct Part {
    std::vector<PrimitivePair> pairs;
    ProximityReport report;
  };
  std::vector<Part> parts((primitives.size() + grain - 1) / grain);
  std::atomic<std::size_t> count = out.pairs.size();
  parallel_for(context, primitives.size(), grain, "close pairs", [&](const WorkRange& range) {
    Part& part = parts[range.begin / grain];
    std::vector<std::uint32_t> seen;
    for (auto row = static_cast<std::uint32_t>(range.begin); row < range.end; ++row) {
      const Box3 box = primitives.box(row);
      for_each_candidate(primitives, cells, row, distance, false, seen, [&](std::uint32_t other) {
        if (other < row || count > most_close_pairs) return;  // each pair once
        ++part.report.candidates;
        if (box_gap(box, primitives.box(other)) > distance) return;
        ++part.report.exact_tests;
        const PrimitivePair pair = primitives.compare(row, other);
        if (pair.between.distance > distance) return;
        part.pairs.push_back(pair);
        ++count;
      });
    }
  });
  check_count(count);
  std::vector<std::vector<PrimitivePair>> found;
  std::vector<ProximityReport> reports;
  for (Part& part : parts) {
    found.push_back(std::move(part.pairs));
    reports.push_back(std::move(part.report));
  }
  add_all(reports, cells, out.report);
  add_sorted(std::move(found), context, out.pairs);
  timer.lap("exact tests");
}

}  // namespace blum::detail
