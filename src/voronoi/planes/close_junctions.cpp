#include "voronoi/planes/close_junctions.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "blum/core/sort_unique.hpp"
#include "blum/core/union_find.hpp"

namespace blum::voronoi {
namespace {

using Loop = std::vector<std::uint32_t>;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

Edge sorted(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

template <class Visit>
void each_edge(const Loop& loop, const Visit& visit) {
  for (std::size_t k = 0; k < loop.size(); ++k) visit(loop[k], loop[(k + 1) % loop.size()]);
}

class Joiner {
 public:
  Joiner(PlaneStructure& structure, double tolerance) : structure_(structure), tolerance_(tolerance) {}

  void run() {
    join_junctions();
    divide_edges();
    for (std::vector<PlaneSheet>* list : {&structure_.sheets, &structure_.surface}) {
      std::vector<PlaneSheet> kept;
      for (const PlaneSheet& sheet : *list) add_reduced(sheet, kept);
      *list = std::move(kept);
    }
    remove_passed_junctions();
    number_again();
  }

 private:
  static constexpr double most_grown = 8;

  /// Returns the tolerance of a junction.
  [[nodiscard]] double reach(std::uint32_t junction) const {
    constexpr double usual = 4;
    return tolerance_ * std::clamp(structure_.junctions[junction].condition / usual, 1.0, most_grown);
  }

  /// Lets each junction within the tolerance of others stand for them: the one with the most planes.
  void join_junctions() {
    auto& junctions = structure_.junctions;
    const auto count = static_cast<std::uint32_t>(junctions.size());
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(junctions[a].at.x, a) < std::pair(junctions[b].at.x, b);
    });
    detail::UnionFind joined(count);
    for (std::uint32_t k = 0; k < count; ++k) {
      for (std::uint32_t m = k + 1; m < count; ++m) {
        const Vec3d step = junctions[order[m]].at - junctions[order[k]].at;
        if (step.x > most_grown * tolerance_) break;
        if (length(step) <= std::max(reach(order[k]), reach(order[m]))) joined.join(order[k], order[m]);
      }
    }
    std::map<std::uint32_t, Loop> groups;
    for (std::uint32_t k = 0; k < count; ++k) groups[joined.find(k)].push_back(k);
    std::vector<std::uint32_t> leader(count);
    for (const auto& [root, members] : groups) {
      const auto rank = [&](std::uint32_t k) {
        return std::pair(junctions[k].height == 0 ? 1 : 0, junctions[k].planes.size());
      };
      std::uint32_t best = members.front();
      for (const std::uint32_t k : members) best = rank(k) > rank(best) ? k : best;
      std::vector<HalfSpaces::Index> planes;
      for (const std::uint32_t k : members) {
        leader[k] = best;
        planes.insert(planes.end(), junctions[k].planes.begin(), junctions[k].planes.end());
      }
      detail::sort_unique(planes);
      junctions[best].planes = std::move(planes);
    }
    for (Loop* loop : loops()) {
      for (std::uint32_t& k : *loop) k = leader[k];
    }
  }

  [[nodiscard]] std::vector<Loop*> loops() {
    std::vector<Loop*> out;
    for (PlaneSheet& sheet : structure_.sheets) out.push_back(&sheet.junctions);
    for (PlaneSheet& sheet : structure_.surface) out.push_back(&sheet.junctions);
    return out;
  }

  /// Adds junctions to the edges that pass them within the tolerance.
  void divide_edges() {
    std::set<Edge> edges;
    std::set<std::uint32_t> used;
    for (const Loop* loop : loops()) {
      each_edge(*loop, [&](std::uint32_t a, std::uint32_t b) {
        if (a != b) edges.insert(sorted(a, b));
        used.insert(a);
      });
    }
    std::map<Edge, Loop> passed;
    for (const Edge& edge : edges) {
      Loop between = junctions_on(edge, used);
      if (!between.empty()) passed[edge] = std::move(between);
    }
    for (Loop* loop : loops()) {
      Loop divided;
      each_edge(*loop, [&](std::uint32_t a, std::uint32_t b) {
        if (a == b) return;
        divided.push_back(a);
        const auto found = passed.find(sorted(a, b));
        if (found == passed.end()) return;
        const Loop& between = found->second;
        if (a < b) divided.insert(divided.end(), between.begin(), between.end());
        if (a > b) divided.insert(divided.end(), between.rbegin(), between.rend());
      });
      *loop = std::move(divided);
    }
  }

  /// Returns the junctions on an edge, from its smaller end to its larger one.
  [[nodiscard]] Loop junctions_on(const Edge& edge, const std::set<std::uint32_t>& used) const {
    const Vec3d& from = structure_.junctions[edge.first].at;
    const Vec3d along = structure_.junctions[edge.second].at - from;
    const double size = squared_length(along);
    std::vector<std::pair<double, std::uint32_t>> found;
    for (const std::uint32_t k : used) {
      if (k == edge.first || k == edge.second) continue;
      const Vec3d step = structure_.junctions[k].at - from;
      const double at = dot(step, along) / size;
      if (at > 0 && at < 1 && length(step - along * at) <= reach(k)) found.emplace_back(at, k);
    }
    std::sort(found.begin(), found.end());
    Loop out;
    for (const auto& [at, k] : found) out.push_back(k);
    return out;
  }

  /// Removes edges that a sheet traverses in both directions. Adds what is left, as one sheet for each loop.
  static void add_reduced(const PlaneSheet& sheet, std::vector<PlaneSheet>& out) {
    std::multimap<std::uint32_t, std::uint32_t> next;
    each_edge(sheet.junctions, [&](std::uint32_t a, std::uint32_t b) {
      const auto [low, high] = next.equal_range(b);
      const auto back = std::find_if(low, high, [&](const auto& entry) { return entry.second == a; });
      if (back != high) {
        next.erase(back);
      } else {
        next.emplace(a, b);
      }
    });
    while (!next.empty()) {
      PlaneSheet part{sheet.first, sheet.second, {}};
      const std::uint32_t start = next.begin()->first;
      std::uint32_t at = start;
      do {
        const auto step = next.find(at);
        part.junctions.push_back(at);
        at = step->second;
        next.erase(step);
      } while (at != start);
      out.push_back(std::move(part));
    }
  }

  /// Removes junctions inside the solid at which exactly two edges end, both of the same sheets.
  void remove_passed_junctions() {
    std::map<Edge, std::vector<Edge>> sheets;
    std::map<std::uint32_t, std::set<Edge>> at;
    for (const std::vector<PlaneSheet>* list : {&structure_.sheets, &structure_.surface}) {
      for (const PlaneSheet& sheet : *list) {
        each_edge(sheet.junctions, [&](std::uint32_t a, std::uint32_t b) {
          const Edge edge = sorted(a, b);
          sheets[edge].emplace_back(sheet.first, sheet.second);
          at[a].insert(edge);
          at[b].insert(edge);
        });
      }
    }
    for (auto& [edge, list] : sheets) std::sort(list.begin(), list.end());
    std::set<std::uint32_t> passed;
    for (const auto& [junction, edges] : at) {
      if (structure_.junctions[junction].height == 0 || edges.size() != 2) continue;
      if (sheets[*edges.begin()] == sheets[*std::next(edges.begin())]) passed.insert(junction);
    }
    for (Loop* loop : loops()) {
      std::erase_if(*loop, [&](std::uint32_t k) { return passed.contains(k); });
    }
  }

  /// Leaves out junctions that no sheet uses any more.
  void number_again() {
    constexpr std::uint32_t unused = UINT32_MAX;
    std::vector<std::uint32_t> number(structure_.junctions.size(), unused);
    for (const Loop* loop : loops()) {
      for (const std::uint32_t k : *loop) number[k] = 0;
    }
    std::vector<PlaneStructure::Junction> kept;
    for (std::size_t k = 0; k < number.size(); ++k) {
      if (number[k] == unused) continue;
      number[k] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(std::move(structure_.junctions[k]));
    }
    structure_.junctions = std::move(kept);
    for (Loop* loop : loops()) {
      for (std::uint32_t& k : *loop) k = number[k];
    }
  }

  PlaneStructure& structure_;
  const double tolerance_;
};

}  // namespace

void join_close_junctions(PlaneStructure& structure, double tolerance) {
  if (tolerance > 0) Joiner(structure, tolerance).run();
}

}  // namespace blum::voronoi
