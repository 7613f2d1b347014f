#include "voronoi/traced/traced_structure.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>

#include "voronoi/traced/seam_graph.hpp"
#include "voronoi/traced/sheet_loops.hpp"
#include "voronoi/traced/trace_problem.hpp"

namespace blum::voronoi {
namespace {

/// Returns the walls from which to look for further boundaries of their sheets: those beside the longest curves of each
/// loop.
std::vector<SeamGraph::Side> sides_to_cross(const TracedStructure& structure, const SheetLoops& loops,
                                            std::size_t per_loop) {
  std::vector<SeamGraph::Side> out;
  for (const std::vector<SeamGraph::Side>& loop : loops.sides) {
    std::vector<std::pair<double, std::size_t>> seams;  // (length with a minus sign, place in the loop)
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const TracedStructure::Curve& curve = structure.curves[loop[k].curve];
      if (!curve.is_edge) seams.emplace_back(-squared_length(curve.points.back() - curve.points.front()), k);
    }
    std::sort(seams.begin(), seams.end());
    for (std::size_t k = 0; k < std::min(per_loop, seams.size()); ++k) out.push_back(loop[seams[k].second]);
  }
  return out;
}

TracedStructure traced(const TracedSites& sites, std::size_t per_loop, SeamGraph& graph) {
  graph.start_at_edges();
  std::set<std::pair<std::uint32_t, std::uint32_t>> crossed;
  for (;;) {
    SheetLoops loops = sheet_loops(sites, graph.structure());
    std::vector<SeamGraph::Side> sides = sides_to_cross(graph.structure(), loops, per_loop);
    std::erase_if(sides, [&](const SeamGraph::Side& side) { return !crossed.insert({side.curve, side.germ}).second; });
    const std::size_t before = graph.structure().curves.size();
    graph.cross(sides);
    if (graph.structure().curves.size() != before) continue;
    TracedStructure out = graph.take();
    out.sheets = std::move(loops.sheets);
    return out;
  }
}

}  // namespace

std::uint64_t usual_work(const TracedSites& sites) {
  constexpr std::uint64_t per_site = 400'000;
  return per_site * sites.size();
}

std::uint64_t default_work(const TracedSites& sites, std::size_t triangles) {
  const std::uint64_t count = sites.size();
  if (2 * sites.face_count() > triangles) {  // few faces have several triangles
    constexpr std::uint64_t least_per_site = 10'000, most_per_site = 40'000, most = 30'000'000;
    return least_per_site * count > most ? 0 : std::min(most_per_site * count, most);
  }
  constexpr std::uint64_t per_small_site = 130'000, base = 110'000'000, per_site = 15'000, most = 300'000'000;
  return std::min({per_small_site * count, base + per_site * count, most});
}

TracedResult traced_structure(const TracedSites& sites, TraceEffort effort, std::uint64_t most_work,
                              const Context& context) {
  TracedResult out;
  SeamGraph graph(sites, most_work, context);
  try {
    constexpr std::size_t few = 2;
    const std::size_t per_loop = effort == TraceEffort::usual ? few : static_cast<std::size_t>(-1);
    out.structure = traced(sites, per_loop, graph);
  } catch (const TraceProblem& problem) {
    out.problem = problem.text;
    out.place = problem.place;
  }
  out.work = graph.work();
  return out;
}

}  // namespace blum::voronoi
