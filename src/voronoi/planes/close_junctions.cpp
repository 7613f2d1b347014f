#include "voronoi/planes/close_junctions.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "blum/core/gather.hpp"
#include "blum/core/sort_unique.hpp"
#include "blum/core/union_find.hpp"

namespace blum::voronoi {
namespace {

using Loop = std::vector<std::uint32_t>;
using Edge = JunctionEdge;

constexpr std::size_t junctions_per_range = 64;

/// Junctions in the order of each coordinate.
class Places {
 public:
  using Place = std::pair<double, std::uint32_t>;

  Places(const std::vector<PlaneStructure::Junction>& junctions, const std::vector<std::uint32_t>& which) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const std::uint32_t k : which) along_[axis].emplace_back(junctions[k].at[axis], k);
      std::sort(along_[axis].begin(), along_[axis].end());
    }
  }

  /// Returns all junctions within a distance of the box of two points, and others.
  [[nodiscard]] std::span<const Place> between(const Vec3d& a, const Vec3d& b, double distance) const {
    std::span<const Place> out(along_[0]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::vector<Place>& all = along_[axis];
      const auto [low, high] = std::minmax(a[axis], b[axis]);
      const auto first = std::lower_bound(all.begin(), all.end(), Place(low - distance, 0));
      const auto last = std::upper_bound(first, all.end(), Place(high + distance, UINT32_MAX));
      if (last - first < static_cast<std::ptrdiff_t>(out.size())) out = std::span<const Place>(first, last);
    }
    return out;
  }

 private:
  std::array<std::vector<Place>, 3> along_;
};

class Joiner {
 public:
  Joiner(PlaneStructure& structure, double tolerance, const Context& context)
      : structure_(structure), tolerance_(tolerance), context_(context) {}

  /// Returns a bound on how far parts of the diagram have moved: the sum of the largest distances of each step.
  double run() {
    const double joined = join_junctions();
    const double divided = divide_edges();
    for (std::vector<PlaneSheet>* list : {&structure_.sheets, &structure_.surface}) {
      std::vector<PlaneSheet> kept;
      for (const PlaneSheet& sheet : *list) add_reduced(sheet, kept);
      *list = std::move(kept);
    }
    const double passed = remove_passed_junctions();
    number_again();
    return joined + divided + passed;
  }

 private:
  static constexpr double most_grown = 8;

  /// Returns the tolerance of a junction.
  [[nodiscard]] double reach(std::uint32_t junction) const {
    constexpr double usual = 4;
    return tolerance_ * std::clamp(structure_.junctions[junction].condition / usual, 1.0, most_grown);
  }

  /// Lets each junction within the tolerance of others stand for them: the one with the most planes.
  /// @return the largest distance of a junction from the one that stands for it.
  double join_junctions() {
    auto& junctions = structure_.junctions;
    const auto count = static_cast<std::uint32_t>(junctions.size());
    std::vector<std::uint32_t> all(count);
    std::iota(all.begin(), all.end(), 0U);
    const Places places(junctions, all);
    const std::vector<Edge> pairs =
        detail::gather<Edge>(context_, count, junctions_per_range, "close junctions", [&](std::size_t k, auto& out) {
          const Vec3d& at = junctions[k].at;
          const auto first = static_cast<std::uint32_t>(k);
          for (const auto& [x, m] : places.between(at, at, most_grown * tolerance_)) {
            if (m > first && length(junctions[m].at - at) <= std::max(reach(first), reach(m)))
              out.emplace_back(first, m);
          }
        });
    detail::UnionFind joined(count);
    for (const auto& [a, b] : pairs) joined.join(a, b);
    double moved = 0;
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
        moved = std::max(moved, length(junctions[k].at - junctions[best].at));
        planes.insert(planes.end(), junctions[k].planes.begin(), junctions[k].planes.end());
      }
      detail::sort_unique(planes);
      junctions[best].planes = std::move(planes);
    }
    for (Loop* loop : loops()) {
      for (std::uint32_t& k : *loop) k = leader[k];
    }
    return moved;
  }

  [[nodiscard]] std::vector<Loop*> loops() {
    std::vector<Loop*> out;
    for (PlaneSheet& sheet : structure_.sheets) out.push_back(&sheet.junctions);
    for (PlaneSheet& sheet : structure_.surface) out.push_back(&sheet.junctions);
    return out;
  }

  /// Adds junctions to the edges that pass them within the tolerance.
  /// @return the largest distance of such a junction from its edge.
  double divide_edges() {
    std::vector<Edge> edges;
    std::vector<std::uint32_t> used;
    for (const Loop* loop : loops()) {
      each_edge(*loop, [&](std::uint32_t a, std::uint32_t b) {
        if (a != b) edges.push_back(sorted_edge(a, b));
        used.push_back(a);
      });
    }
    detail::sort_unique(edges);
    detail::sort_unique(used);
    const Places places(structure_.junctions, used);
    const std::vector<DividedEdge> divisions = detail::gather<DividedEdge>(
        context_, edges.size(), junctions_per_range, "close seams", [&](std::size_t k, auto& out) {
          DividedEdge found = divided_edge(edges[k], places);
          if (!found.between.empty()) out.push_back(std::move(found));
        });
    double moved = 0;
    std::map<Edge, Loop> passed;
    for (const DividedEdge& division : divisions) {
      passed[division.edge] = division.between;
      moved = std::max(moved, division.distance);
    }
    for (Loop* loop : loops()) {
      Loop divided;
      each_edge(*loop, [&](std::uint32_t a, std::uint32_t b) {
        if (a == b) return;
        divided.push_back(a);
        const auto found = passed.find(sorted_edge(a, b));
        if (found == passed.end()) return;
        const Loop& between = found->second;
        if (a < b) divided.insert(divided.end(), between.begin(), between.end());
        if (a > b) divided.insert(divided.end(), between.rbegin(), between.rend());
      });
      *loop = std::move(divided);
    }
    return moved;
  }

  struct DividedEdge {
    Edge edge;
    Loop between;         ///< the junctions on the edge, from its smaller end to its larger one
    double distance = 0;  ///< the largest distance of one from the edge
  };

  [[nodiscard]] DividedEdge divided_edge(const Edge& edge, const Places& places) const {
    const Vec3d& from = structure_.junctions[edge.first].at;
    const Vec3d& to = structure_.junctions[edge.second].at;
    const Vec3d along = to - from;
    const double size = squared_length(along);
    DividedEdge out{edge, {}, 0};
    std::vector<std::pair<double, std::uint32_t>> found;
    for (const auto& [x, k] : places.between(from, to, most_grown * tolerance_)) {
      if (k == edge.first || k == edge.second) continue;
      const Vec3d step = structure_.junctions[k].at - from;
      const double at = dot(step, along) / size;
      const double distance = length(step - along * at);
      if (!(at > 0 && at < 1 && distance <= reach(k))) continue;
      found.emplace_back(at, k);
      out.distance = std::max(out.distance, distance);
    }
    std::sort(found.begin(), found.end());
    for (const auto& [at, k] : found) out.between.push_back(k);
    return out;
  }

  /// Removes edges that a sheet traverses in both directions. Adds one sheet for each loop of the remaining edges.
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
  /// @return the largest distance of one from the straight edge between those that stay.
  double remove_passed_junctions() {
    std::map<Edge, std::vector<Edge>> sheets;
    std::map<std::uint32_t, std::set<Edge>> at;
    for (const std::vector<PlaneSheet>* list : {&structure_.sheets, &structure_.surface}) {
      for (const PlaneSheet& sheet : *list) {
        each_edge(sheet.junctions, [&](std::uint32_t a, std::uint32_t b) {
          const Edge edge = sorted_edge(a, b);
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
    double moved = 0;
    for (Loop* loop : loops()) {
      const auto is_passed = [&](std::uint32_t k) { return passed.contains(k); };
      if (std::none_of(loop->begin(), loop->end(), is_passed)) continue;
      const auto kept = std::find_if_not(loop->begin(), loop->end(), is_passed);
      if (kept != loop->end()) {
        std::rotate(loop->begin(), kept, loop->end());
        moved = std::max(moved, distance_from_chords(*loop, passed));
      }
      std::erase_if(*loop, is_passed);
    }
    return moved;
  }

  /// Returns the largest distance of a passed junction from the line between those before and after it that stay.
  /// @param loop  starts with one that stays.
  [[nodiscard]] double distance_from_chords(const Loop& loop, const std::set<std::uint32_t>& passed) const {
    const auto at = [&](std::size_t k) -> const Vec3d& { return structure_.junctions[loop[k % loop.size()]].at; };
    double most = 0;
    std::size_t from = 0;
    for (std::size_t to = 1; to <= loop.size(); ++to) {
      if (to < loop.size() && passed.contains(loop[to])) continue;
      const Vec3d along = at(to) - at(from);
      const double size = squared_length(along);
      for (std::size_t k = from + 1; k < to; ++k) {
        const Vec3d step = at(k) - at(from);
        const double part = size > 0 ? std::clamp(dot(step, along) / size, 0.0, 1.0) : 0;
        most = std::max(most, length(step - along * part));
      }
      from = to;
    }
    return most;
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
  const Context& context_;
};

/// Returns V - E + F of the sheets and the surface.
std::int64_t euler_number(const PlaneStructure& structure) {
  std::vector<JunctionEdge> edges;
  for (const std::vector<PlaneSheet>* list : {&structure.sheets, &structure.surface}) {
    for (const PlaneSheet& sheet : *list) {
      each_edge(sheet.junctions, [&](std::uint32_t a, std::uint32_t b) { edges.push_back(sorted_edge(a, b)); });
    }
  }
  detail::sort_unique(edges);
  return static_cast<std::int64_t>(structure.junctions.size() + structure.sheets.size() + structure.surface.size()) -
         static_cast<std::int64_t>(edges.size());
}

/// Returns true if polygons form a sphere: each edge belongs to two, and the Euler number is 2.
bool is_sphere(const std::vector<const PlaneSheet*>& polygons) {
  std::vector<std::uint32_t> corners;
  std::vector<JunctionEdge> edges;
  for (const PlaneSheet* polygon : polygons) {
    if (polygon->junctions.size() < 3) return false;
    each_edge(polygon->junctions, [&](std::uint32_t a, std::uint32_t b) {
      edges.push_back(sorted_edge(a, b));
      corners.push_back(a);
    });
  }
  const std::size_t sides = edges.size();
  std::sort(edges.begin(), edges.end());
  if (sides % 2 != 0) return false;
  for (std::size_t k = 0; k < sides; k += 2) {
    if (edges[k] != edges[k + 1]) return false;
  }
  detail::sort_unique(edges);
  detail::sort_unique(corners);
  return 2 * edges.size() == sides && corners.size() + polygons.size() == edges.size() + 2;
}

/// Returns true if a structure is that of planes that divide a ball into regions, one for each plane. Each plane then
/// has one polygon, and the border of its region is a sphere. The union of all polygons has the Euler number 1 plus the
/// number of regions.
bool is_division(const PlaneStructure& structure, std::size_t planes) {
  if (structure.surface.size() != planes) return false;
  if (euler_number(structure) != 1 + static_cast<std::int64_t>(planes)) return false;
  std::vector<std::vector<const PlaneSheet*>> borders(planes);
  for (std::size_t plane = 0; plane < planes; ++plane) {
    if (structure.surface[plane].first != plane) return false;
    borders[plane].push_back(&structure.surface[plane]);
  }
  for (const PlaneSheet& sheet : structure.sheets) {
    borders[sheet.first].push_back(&sheet);
    borders[sheet.second].push_back(&sheet);
  }
  return std::all_of(borders.begin(), borders.end(), is_sphere);
}

/// Joins parts of a diagram that lie within a tolerance of each other. Junctions within the tolerance are merged. A
/// seam that passes a junction within the tolerance is divided there. Seams with the same ends become one, and sheets
/// without an area vanish. A junction vanishes if exactly two seams end there, between the same regions.
///
/// The tolerance of a junction grows with its condition, up to 8 times: where planes meet at small angles, rounding
/// moves it further.
/// @param tolerance  >= 0, mesh units; 0 changes nothing.
/// @return a bound on the Hausdorff distance between the diagram before and after, mesh units.
double join_close_junctions(PlaneStructure& structure, double tolerance, const Context& context) {
  return tolerance > 0 ? Joiner(structure, tolerance, context).run() : 0;
}

}  // namespace

JoinedJunctions restore_degenerate(PlaneStructure& structure, double tolerance, const Context& context) {
  const std::size_t planes = structure.surface.size();
  double size = 0;
  for (const PlaneStructure::Junction& junction : structure.junctions) size = std::max(size, length(junction.at));
  // Fractions of the size. The caller may ask for a larger distance than the search would try.
  constexpr double most_searched = 1e-4;
  constexpr double most_asked = 1e-2;
  const double most = std::max(most_searched * size, std::min(tolerance, most_asked * size));
  constexpr double step = 8;
  for (double distance = tolerance; distance > 0 && distance <= most; distance *= step) {
    PlaneStructure joined = structure;
    const double moved = join_close_junctions(joined, distance, context);
    if (joined.junctions.size() == structure.junctions.size()) return {};
    if (!is_division(joined, planes)) continue;
    structure = std::move(joined);
    return {distance, moved};
  }
  return {};
}

}  // namespace blum::voronoi
