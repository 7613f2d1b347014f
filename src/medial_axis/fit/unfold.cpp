#include "medial_axis/fit/unfold.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/gather.hpp"
#include "blum/core/sort_unique.hpp"
#include "blum/core/union_find.hpp"
#include "blum/geometry/closest_point.hpp"
#include "medial_axis/fit/kind.hpp"
#include "medial_axis/fit/shrinking_lists.hpp"

namespace blum::detail {
namespace {

/// Greatest number of triangles of a crumb, which is a very small sheet.
constexpr std::uint32_t most_of_crumb = 8;

/// Returns the edges of sheets that are crumbs, and the edges of curves that lead from a sheet to a free end.
std::vector<std::array<std::uint32_t, 2>> edges_of_crumbs(const Incidence& incidence) {
  detail::UnionFind sheets = sheets_of(incidence);
  std::vector<std::uint32_t> size(incidence.sides().size(), 0);
  for (std::uint32_t t = 0; t < size.size(); ++t) ++size[sheets.find(t)];
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (std::uint32_t t = 0; t < size.size(); ++t) {
    if (size[sheets.find(t)] > most_of_crumb) continue;
    for (const std::uint32_t e : incidence.sides()[t]) edges.push_back(incidence.edges()[e]);
  }
  const auto is_end = [&](std::uint32_t v) { return incidence.edges_of_vertex()[v].size() == 1; };
  const auto is_on_sheet = [&](std::uint32_t v) { return !incidence.triangles_of_vertex()[v].empty(); };
  for (const std::uint32_t e : incidence.edge_of_listed()) {
    const auto& [a, b] = incidence.edges()[e];
    if ((is_end(a) && is_on_sheet(b)) || (is_end(b) && is_on_sheet(a))) edges.push_back(incidence.edges()[e]);
  }
  detail::sort_unique(edges);
  return edges;
}

/// Height of a triangle, in voxels, up to which its corners count as lying on a line.
constexpr double sliver = 0.1;
/// Greatest radius of thin parts, in voxels.
constexpr double thin_part = 4;
/// Greatest distance by which contractions may shorten a curve or strip at its end, as a share of the radius there.
constexpr double most_shortened = 0.25;

class ShortEdges {
 public:
  ShortEdges(AxisLists& lists, const Incidence& incidence, const Surface& surface, double voxel,
             const ShortLengths& lengths, const Context& context)
      : lists_(lists, incidence, surface, 1),
        shortened_(lists.vertices.size(), 0),
        scratch_(static_cast<std::size_t>(thread_count(context))),
        voxel_(voxel),
        lengths_(lengths),
        context_(context) {
    is_on_curve_.assign(lists.vertices.size(), false);
    for (const std::uint32_t e : incidence.edge_of_listed()) {
      if (!incidence.triangles_of_edge()[e].empty()) continue;
      for (const std::uint32_t v : incidence.edges()[e]) is_on_curve_[v] = true;
    }
    if (lengths.of_crumbs > 0) crumbs_ = edges_of_crumbs(lists_.incidence());
    if (lengths.of_slivers > 0) find_slivers(lists.triangles);
    find_short();
  }

  /// @return  true if any edge was contracted.
  bool run() {
    const std::size_t all = short_.size();
    // A contraction may make other contractions possible that were forbidden before.
    for (bool is_changed = true; is_changed && !short_.empty();) {
      const std::size_t count = short_.size();
      std::vector<ShortEdge> left;
      take_in_batches(
          context_, short_.size(), lists_,
          [&](std::size_t k, int worker) { return step_of(short_[k], scratch_[static_cast<std::size_t>(worker)]); },
          [&](std::size_t k, const ContractionStep& step) {
            if (step.is_gone) return;
            if (step.contraction) {
              contract(*step.contraction);
              return;
            }
            left.push_back(short_[k]);
            left.back().looked = lists_.contractions();
          });
      short_ = std::move(left);
      is_changed = short_.size() < count;
    }
    if (short_.size() == all) return false;
    lists_.write();
    return true;
  }

 private:
  using Edge = std::array<std::uint32_t, 2>;
  struct ShortEdge {
    double length;
    std::uint32_t a, b;
    /// ShrinkingLists::contractions() when the edge was last examined and not contracted; else 0
    std::uint32_t looked = 0;
    bool operator<(const ShortEdge& other) const {
      return std::tie(length, a, b) < std::tie(other.length, other.a, other.b);
    }
  };

  void find_short() {
    constexpr std::size_t grain = 4096;
    const auto& edges = lists_.incidence().edges();
    short_ = detail::gather<ShortEdge>(context_, edges.size(), grain, {}, [&](std::size_t e, auto& found) {
      const auto& [a, b] = edges[e];
      const double size = length(lists_.position(a) - lists_.position(b));
      if (size <= limit(a, b, longest(a, b))) found.push_back({size, a, b});
    });
    std::sort(short_.begin(), short_.end());
  }

  void find_slivers(const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    for (const auto& t : triangles) {
      if (std::min({lists_.rank(t[0]), lists_.rank(t[1]), lists_.rank(t[2])}) == 0) continue;
      std::array<std::pair<double, Edge>, 3> sides;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k];
        const std::uint32_t b = t[(k + 1) % 3];
        sides[k] = {length(lists_.position(a) - lists_.position(b)), {std::min(a, b), std::max(a, b)}};
      }
      std::sort(sides.begin(), sides.end());
      const double twice_area =
          length(cross(lists_.position(t[1]) - lists_.position(t[0]), lists_.position(t[2]) - lists_.position(t[0])));
      if (twice_area <= sliver * voxel_ * sides[2].first) slivers_.push_back(sides[0].second);
    }
    detail::sort_unique(slivers_);
  }

  /// Returns the greatest length, in voxels, at which a side of a sliver or crumb may be contracted; 0 for other edges.
  [[nodiscard]] double longest(std::uint32_t a, std::uint32_t b) const {
    const Edge edge{std::min(a, b), std::max(a, b)};
    const bool is_of_sliver = std::binary_search(slivers_.begin(), slivers_.end(), edge);
    const bool is_of_crumb = std::binary_search(crumbs_.begin(), crumbs_.end(), edge);
    return std::max(is_of_sliver ? lengths_.of_slivers : 0, is_of_crumb ? lengths_.of_crumbs : 0);
  }
  [[nodiscard]] double limit(std::uint32_t a, std::uint32_t b, double least_voxels) const {
    const int least = std::min(lists_.rank(a), lists_.rank(b));
    const double voxels = least >= ShrinkingLists::on_seam ? lengths_.on_seams
                          : least > 0                      ? lengths_.on_rims
                                                           : lengths_.others;
    return std::max({voxels, least_voxels, is_at_corner(a, b) ? lengths_.at_corners : 0}) * voxel_;
  }

  /// Returns true if an edge leads from a vertex on a rim to the end of a seam in a corner of the solid.
  [[nodiscard]] bool is_at_corner(std::uint32_t a, std::uint32_t b) const {
    constexpr double next_to = 2;  // voxels
    if (lists_.rank(a) > lists_.rank(b)) std::swap(a, b);
    const bool is_on_rim = lists_.rank(a) % ShrinkingLists::on_seam > 0;
    return is_on_rim && lists_.rank(a) < ShrinkingLists::end_of_seam * ShrinkingLists::on_seam && !is_on_curve_[b] &&
           lists_.rank(b) / ShrinkingLists::on_seam == ShrinkingLists::end_of_seam &&
           lists_.radius(b) < next_to * voxel_;
  }

  /// Returns true if the contraction would move a vertex of a rim to an inner vertex of a seam. Such a contraction
  /// would cut a notch into the sheet. Sheets without inner vertices are excepted: such a ribbon in the middle of a
  /// round part shall become a curve.
  [[nodiscard]] bool would_notch(std::uint32_t a, std::uint32_t b) const {
    if (lists_.rank(a) > lists_.rank(b)) std::swap(a, b);
    const bool is_at_seam =
        lists_.rank(a) > 0 && lists_.rank(a) < ShrinkingLists::on_seam && lists_.rank(b) == 2 * ShrinkingLists::on_seam;
    if (!is_at_seam) return false;
    bool has_inside = false;
    lists_.cells().for_each_triangle(a, [&](std::uint32_t, std::uint32_t p, std::uint32_t q) {
      has_inside = has_inside || lists_.rank(p) == 0 || lists_.rank(q) == 0;
    });
    return has_inside;
  }

  /// Returns the step of a short edge: its contraction, if allowed.
  [[nodiscard]] ContractionStep step_of(const ShortEdge& edge, LinkScratch& scratch) const {
    std::uint32_t from = lists_.now(edge.a);
    std::uint32_t to = lists_.now(edge.b);
    if (from == to) return {.is_gone = true};
    ContractionStep step{.near = {from, to}};
    if (edge.looked > 0 && std::max(lists_.changed(from), lists_.changed(to)) <= edge.looked) return step;
    const double size = length(lists_.position(from) - lists_.position(to));
    const double of_its_cells = longest(edge.a, edge.b);
    if (size > 2 * limit(from, to, of_its_cells)) return step;
    if (of_its_cells == 0 && would_notch(from, to)) return step;
    // The vertex with the higher rank stays: vertices of seams and curves before those of rims, these before inner
    // vertices. If the ranks are equal, the vertex with two footprints stays.
    const auto worth = [&](std::uint32_t v) { return std::pair(lists_.rank(v), lists_.angle(v) > 0); };
    if (std::tuple(worth(from), to) > std::tuple(worth(to), from)) std::swap(from, to);
    if (shortens(from, to) || !lists_.may_contract(from, to, scratch)) {
      std::swap(from, to);
      if (is_at_corner(from, to) || shortens(from, to) || !lists_.may_contract(from, to, scratch)) return step;
    }
    step.contraction = {from, to};
    return step;
  }

  void contract(const Contraction& step) {
    if (are_on_strip(step.from, step.to)) {
      double& shortened = shortened_[step.to];
      shortened = std::max(shortened, shortened_[step.from] + uncovered_by(step.from, step.to));
    }
    lists_.contract(step.from, step.to);
  }

  // ---- Ends of curves and strips ----

  /// Returns true if two vertices belong to a curve or strip of a thin part: to no sheet with vertices inside.
  [[nodiscard]] bool are_on_strip(std::uint32_t a, std::uint32_t b) const { return is_on_strip(a) && is_on_strip(b); }
  [[nodiscard]] bool is_on_strip(std::uint32_t v) const {
    bool is_strip = lists_.rank(v) > 0 && lists_.radius(v) <= thin_part * voxel_;
    lists_.cells().for_each_triangle(v, [&](std::uint32_t, std::uint32_t p, std::uint32_t q) {
      is_strip = is_strip && lists_.rank(p) > 0 && lists_.rank(q) > 0;
    });
    return is_strip;
  }
  /// Returns the distance of a vertex from the edges that would meet at `to` if the vertex were contracted to it. This
  /// distance is small between two neighbours on a line, but not at the end of a strip.
  [[nodiscard]] double uncovered_by(std::uint32_t from, std::uint32_t to) const {
    const Vec3d& at = lists_.position(from);
    const Vec3d& end = lists_.position(to);
    double least = squared_length(at - end);
    const auto look = [&](std::uint32_t other) {
      if (other == from || other == to) return;
      least = std::min(least, squared_length(at - closest_point_on_segment(at, end, lists_.position(other))));
    };
    for (const std::uint32_t v : {from, to}) {
      lists_.cells().for_each_triangle(v, [&](std::uint32_t, std::uint32_t p, std::uint32_t q) {
        look(p);
        look(q);
      });
      lists_.cells().for_each_edge(v, [&](std::uint32_t, std::uint32_t other) { look(other); });
    }
    return std::sqrt(least);
  }
  /// Returns true if a contraction, together with those before it, would shorten a curve or strip too much at its end.
  [[nodiscard]] bool shortens(std::uint32_t from, std::uint32_t to) const {
    if (!are_on_strip(from, to)) return false;
    const double most = most_shortened * std::max(lists_.radius(from), lists_.radius(to));
    return shortened_[from] + uncovered_by(from, to) > most;
  }

  ShrinkingLists lists_;
  /// For each vertex: sum of uncovered_by() along the chain of contractions to it for which the sum is largest.
  std::vector<double> shortened_;
  std::vector<LinkScratch> scratch_;  ///< memory of each thread
  double voxel_;
  ShortLengths lengths_;
  std::vector<bool> is_on_curve_;
  std::vector<Edge> crumbs_, slivers_;  ///< sides of crumbs, and shortest sides of slivers; sorted
  const Context& context_;
  std::vector<ShortEdge> short_;
};

using Triangle3 = std::array<std::uint32_t, 3>;

/// A sheet is folded at an edge if the cosine of the angle by which it bends at this edge is below this value.
constexpr double folded = 0.3;
constexpr double most_moved = 2;  ///< voxels: longest edge that is contracted
constexpr int most_rounds = 4;
/// Number of edges. All triangles that are examined for an edge have a corner at most three edges away from its ends.
constexpr int reach = 4;

class Unfolder {
 public:
  Unfolder(AxisLists& lists, const Incidence& incidence, const Surface& surface, const UnfoldLimits& limits,
           const Context& context)
      : lists_(lists, incidence, surface, reach),
        most_moved_(most_moved * limits.voxel),
        most_radius_(limits.most_radius),
        context_(context),
        scratch_(static_cast<std::size_t>(thread_count(context))) {}

  /// @return  true if anything was contracted.
  bool run() {
    const std::uint32_t before = lists_.contractions();
    looked_.assign(lists_.incidence().edges().size(), 0);
    for (int round = 0; round < most_rounds; ++round) {
      const std::vector<std::uint32_t> folded = folded_edges();
      bool is_changed = false;
      take_in_batches(
          context_, folded.size(), lists_, [&](std::size_t k, int worker) { return step_of(folded[k], worker); },
          [&](std::size_t k, const ContractionStep& step) {
            if (step.contraction) lists_.contract(step.contraction->from, step.contraction->to);
            is_changed = is_changed || step.contraction;
            looked_[folded[k]] = step.contraction ? 0 : lists_.contractions();
          });
      if (!is_changed) break;
    }
    if (lists_.contractions() == before) return false;
    lists_.write();
    return true;
  }

 private:
  struct Side {
    std::array<std::uint32_t, 2> ends;
    std::uint32_t third;
    bool operator<(const Side& other) const { return ends < other.ends; }
  };
  /// Triangles around a vertex, prepared to count the folds between them for any position of the vertex.
  struct Around {
    /// Sides of the triangles that do not contain the vertex; sorted.
    std::vector<Side> fixed;
    std::size_t fixed_folds = 0;  ///< number of folds at the sides in `fixed`
    /// The two other corners of each triangle that contains the vertex.
    std::vector<std::array<std::uint32_t, 2>> corners;
  };

  /// Memory of one thread, reused to avoid allocations.
  struct Scratch {
    LinkScratch links;
    std::vector<Side> moved, at_edge;  ///< memory of folds()
  };

  /// Returns the edges at which a sheet is folded. It skips edges near which nothing has changed since their last
  /// examination. The edges are ordered by in_strands().
  [[nodiscard]] std::vector<std::uint32_t> folded_edges() {
    constexpr std::size_t grain = 4096;
    const auto& edges = lists_.incidence().edges();
    return in_strands(detail::gather<std::uint32_t>(context_, edges.size(), grain, {}, [&](std::size_t e, auto& found) {
      const std::uint32_t p = lists_.now(edges[e][0]);
      const std::uint32_t q = lists_.now(edges[e][1]);
      if (p == q || std::max(lists_.radius(p), lists_.radius(q)) > most_radius_ || stays_as_it_was(e, p, q)) return;
      looked_[e] = lists_.contractions();
      if (is_folded_at(p, q)) found.push_back(static_cast<std::uint32_t>(e));
    }));
  }

  [[nodiscard]] ContractionStep step_of(std::uint32_t e, int worker) {
    const std::uint32_t p = lists_.now(lists_.incidence().edges()[e][0]);
    const std::uint32_t q = lists_.now(lists_.incidence().edges()[e][1]);
    if (p == q) return {.is_gone = true};
    ContractionStep step{.near = {p, q}};
    if (is_folded_at(p, q)) step.contraction = unfolded_by(p, q, scratch_[static_cast<std::size_t>(worker)]);
    return step;
  }

  /// Returns true if two triangles with a common edge are folded onto each other; false if one has no area.
  [[nodiscard]] bool is_folded(const std::array<std::uint32_t, 2>& edge, std::uint32_t p, std::uint32_t q) const {
    return cosine_of_bend(lists_.position(edge[0]), lists_.position(edge[1]), lists_.position(p), lists_.position(q)) <
           folded;
  }
  [[nodiscard]] bool is_folded_at(std::uint32_t a, std::uint32_t b) const {
    std::array<std::uint32_t, 2> thirds{};
    std::size_t count = 0;
    lists_.cells().for_each_triangle(a, [&](std::uint32_t, std::uint32_t p, std::uint32_t q) {
      if (p != b && q != b) return;
      if (count < 2) thirds[count] = p == b ? q : p;
      ++count;
    });
    return count == 2 && is_folded({a, b}, thirds[0], thirds[1]);
  }

  static Side side_of(std::uint32_t p, std::uint32_t q, std::uint32_t third) {
    return {{std::min(p, q), std::max(p, q)}, third};
  }
  [[nodiscard]] bool is_folded(std::span<const Side> at_one_edge) const {
    return at_one_edge.size() == 2 && is_folded(at_one_edge[0].ends, at_one_edge[0].third, at_one_edge[1].third);
  }
  template <class Visit>
  static void for_each_edge(std::span<const Side> sorted, const Visit& visit) {
    for (std::size_t first = 0, last = 0; first < sorted.size(); first = last) {
      while (last < sorted.size() && sorted[last].ends == sorted[first].ends) ++last;
      visit(sorted.subspan(first, last - first));
    }
  }

  [[nodiscard]] Around around(std::uint32_t v) const {
    Around out;
    for (const Triangle3& t : triangles_around(v)) {
      const auto at = static_cast<std::size_t>(std::find(t.begin(), t.end(), v) - t.begin());
      if (at < 3) {
        out.corners.push_back({t[(at + 1) % 3], t[(at + 2) % 3]});
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) out.fixed.push_back(side_of(t[k], t[(k + 1) % 3], t[(k + 2) % 3]));
    }
    std::sort(out.fixed.begin(), out.fixed.end());
    for_each_edge(out.fixed, [&](std::span<const Side> at) { out.fixed_folds += is_folded(at) ? 1 : 0; });
    return out;
  }
  /// Returns the number of folds that the triangles around a vertex would have if the vertex were contracted to vertex
  /// `to`.
  [[nodiscard]] std::size_t folds(const Around& around, std::uint32_t to, Scratch& scratch) const {
    std::vector<Side>& moved = scratch.moved;
    moved.clear();
    for (const auto& [p, q] : around.corners) {
      if (p == to || q == to) continue;
      moved.insert(moved.end(), {side_of(p, q, to), side_of(p, to, q), side_of(q, to, p)});
    }
    std::sort(moved.begin(), moved.end());
    std::size_t count = around.fixed_folds;
    for_each_edge(moved, [&](std::span<const Side> at) {
      const auto [first, last] = std::equal_range(around.fixed.begin(), around.fixed.end(), at[0]);
      const std::span<const Side> beside(first, last);
      if (beside.size() > 2) return;  // folded neither before nor after
      scratch.at_edge.assign(beside.begin(), beside.end());
      count -= is_folded(scratch.at_edge) ? 1 : 0;
      scratch.at_edge.insert(scratch.at_edge.end(), at.begin(), at.end());
      count += is_folded(scratch.at_edge) ? 1 : 0;
    });
    return count;
  }

  /// Returns the triangles that contain a vertex, and the triangles with an edge between two neighbours of it. The
  /// returned triangles may fold when the vertex moves to one of its neighbours.
  [[nodiscard]] std::vector<Triangle3> triangles_around(std::uint32_t v) const {
    std::vector<std::uint32_t> around{v};
    lists_.cells().for_each_triangle(v, [&](std::uint32_t, std::uint32_t p, std::uint32_t q) {
      around.push_back(p);
      around.push_back(q);
    });
    detail::sort_unique(around);
    std::vector<std::uint32_t> numbers;
    for (const std::uint32_t u : around) {
      lists_.cells().for_each_triangle(u, [&](std::uint32_t t, std::uint32_t, std::uint32_t) { numbers.push_back(t); });
    }
    detail::sort_unique(numbers);
    std::vector<Triangle3> triangles;
    for (const std::uint32_t t : numbers) {
      const Triangle3& corners = lists_.cells().triangle(t);
      const auto near = std::count_if(corners.begin(), corners.end(), [&](std::uint32_t u) {
        return std::binary_search(around.begin(), around.end(), u);
      });
      if (near > 1) triangles.push_back(corners);
    }
    return triangles;
  }

  [[nodiscard]] std::size_t triangles_at(std::uint32_t a, std::uint32_t b) const {
    std::size_t count = 0;
    lists_.cells().for_each_triangle(
        a, [&](std::uint32_t, std::uint32_t p, std::uint32_t q) { count += p == b || q == b ? 1 : 0; });
    return count;
  }
  /// Returns true if a move keeps borders: if the vertex is inside a sheet, or moves along its rim or seam.
  [[nodiscard]] bool keeps_borders(std::uint32_t from, std::uint32_t to) const {
    const int rank = lists_.rank(from);
    if (rank == 0) return true;
    const std::size_t count = triangles_at(from, to);
    return rank == 2 ? count == 1 : rank == 2 * ShrinkingLists::on_seam && count > 2;
  }

  /// Returns the contraction that removes most folds around a folded edge, or nullopt if no contraction removes any.
  [[nodiscard]] std::optional<Contraction> unfolded_by(std::uint32_t a, std::uint32_t b, Scratch& scratch) const {
    // The best contraction leaves the fewest folds; of equal ones, it has the shortest edge.
    using Found = std::tuple<std::ptrdiff_t, double, std::uint32_t, std::uint32_t>;
    std::optional<Found> best;
    std::vector<std::uint32_t> corners{a, b};
    lists_.cells().for_each_triangle(a, [&](std::uint32_t, std::uint32_t p, std::uint32_t q) {
      if (p == b || q == b) corners.push_back(p == b ? q : p);
    });
    for (const std::uint32_t from : corners) {
      if (lists_.radius(from) > most_radius_) continue;
      const Around triangles = around(from);
      const auto before = static_cast<std::ptrdiff_t>(folds(triangles, from, scratch));
      for (const std::uint32_t to : neighbours(from)) {
        const double size = length(lists_.position(from) - lists_.position(to));
        if (size > most_moved_ || !keeps_borders(from, to)) continue;
        const auto after = static_cast<std::ptrdiff_t>(folds(triangles, to, scratch));
        const Found found{after - before, size, from, to};
        if (after >= before || (best && *best <= found)) continue;
        if (lists_.may_contract(from, to, scratch.links)) best = found;
      }
    }
    if (!best) return std::nullopt;
    return Contraction{std::get<2>(*best), std::get<3>(*best)};
  }

  /// Returns true if nothing near an edge has changed since it was examined and not contracted.
  [[nodiscard]] bool stays_as_it_was(std::size_t e, std::uint32_t p, std::uint32_t q) const {
    return looked_[e] > 0 && std::max(lists_.changed(p), lists_.changed(q)) <= looked_[e];
  }
  [[nodiscard]] std::vector<std::uint32_t> neighbours(std::uint32_t v) const {
    std::vector<std::uint32_t> all;
    lists_.cells().for_each_triangle(v, [&](std::uint32_t, std::uint32_t p, std::uint32_t q) {
      all.push_back(p);
      all.push_back(q);
    });
    detail::sort_unique(all);
    return all;
  }

  ShrinkingLists lists_;
  double most_moved_;
  double most_radius_;
  const Context& context_;
  std::vector<Scratch> scratch_;  ///< For each thread.
  /// For each edge of the incidence: contractions() when it was last examined and not contracted; else 0.
  std::vector<std::uint32_t> looked_;
};

}  // namespace

bool contract_short(AxisLists& lists, const Incidence& incidence, const Surface& surface, double voxel,
                    const ShortLengths& lengths, const Context& context) {
  return ShortEdges(lists, incidence, surface, voxel, lengths, context).run();
}

bool unfold(AxisLists& lists, const Incidence& incidence, const Surface& surface, const UnfoldLimits& limits,
            const Context& context) {
  return Unfolder(lists, incidence, surface, limits, context).run();
}

}  // namespace blum::detail
