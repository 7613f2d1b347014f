#include "medial_axis/fit/unfold.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "blum/core/gather.hpp"
#include "blum/core/sort_unique.hpp"
#include "medial_axis/fit/bend.hpp"
#include "medial_axis/fit/shrinking_lists.hpp"

namespace blum::detail {
namespace {

using Triangle3 = std::array<std::uint32_t, 3>;

/// Cosine of the angle by which a sheet bends at an edge, from which on it is folded.
constexpr double folded = 0.3;
constexpr double most_moved = 2;  ///< voxels
constexpr int most_rounds = 4;
/// What is looked at around an edge are triangles with a corner up to three steps from its ends.
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

  /// @return  whether anything was contracted.
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
  /// Triangles around a vertex, ready to tell how they fold wherever this one goes.
  struct Around {
    std::vector<Side> fixed;                            ///< of the triangles that do not have the vertex; sorted
    std::size_t fixed_folds = 0;                        ///< at these
    std::vector<std::array<std::uint32_t, 2>> corners;  ///< the other two, of the triangles that have it
  };

  /// Of one thread, kept so that no new memory is needed each time.
  struct Scratch {
    LinkScratch links;
    std::vector<Side> moved, at_edge;  ///< of folds()
  };

  /// The edges where a sheet is folded now, but for those around which nothing has changed since they were looked at in
  /// vain: each next to the one a batch before, and far from those right before it.
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

  /// Whether two triangles at an edge lie one over the other; one without area bends nothing.
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
  /// Folds between the triangles around a vertex, were it at another one.
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

  /// The triangles of a vertex, and those with an edge between two around it: what may fold when the vertex moves to
  /// one of these.
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
  /// Whether a vertex leaves nothing behind that it bounds: inside of a sheet, or along its rim or seam.
  [[nodiscard]] bool keeps_borders(std::uint32_t from, std::uint32_t to) const {
    const int rank = lists_.rank(from);
    if (rank == 0) return true;
    const std::size_t count = triangles_at(from, to);
    return rank == 2 ? count == 1 : rank == 2 * ShrinkingLists::on_seam && count > 2;
  }

  /// The contraction that takes most folds away around a folded edge, if any does.
  [[nodiscard]] std::optional<Contraction> unfolded_by(std::uint32_t a, std::uint32_t b, Scratch& scratch) const {
    // Less folds, then a shorter edge.
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

  /// Whether nothing near an edge has changed since it was looked at in vain.
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
  std::vector<Scratch> scratch_;       ///< of each thread
  std::vector<std::uint32_t> looked_;  ///< at each edge of the lists, in vain, after so many contractions; or 0
};

}  // namespace

bool unfold(AxisLists& lists, const Incidence& incidence, const Surface& surface, const UnfoldLimits& limits,
            const Context& context) {
  return Unfolder(lists, incidence, surface, limits, context).run();
}

}  // namespace blum::detail
