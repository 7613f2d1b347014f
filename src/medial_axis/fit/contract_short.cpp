#include "medial_axis/fit/contract_short.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/gather.hpp"
#include "blum/core/sort_unique.hpp"
#include "blum/core/union_find.hpp"
#include "medial_axis/fit/kind.hpp"
#include "medial_axis/fit/shrinking_lists.hpp"

namespace blum::detail {
namespace {

/// Sheets of up to so many triangles are crumbs.
constexpr std::uint32_t most_of_crumb = 8;

/// The edges of sheets of a few triangles, and of curves that end next to a sheet.
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

/// Height of a triangle whose corners lie on a line, in voxels.
constexpr double sliver = 0.1;

class ShortEdges {
 public:
  ShortEdges(AxisLists& lists, const Incidence& incidence, const Surface& surface, double voxel,
             const ShortLengths& lengths, const Context& context)
      : lists_(lists, incidence, surface, 1),
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

  /// @return  whether any edge was contracted.
  bool run() {
    const std::size_t all = short_.size();
    // What one contraction forbids another one may allow.
    for (bool is_changed = true; is_changed && !short_.empty();) {
      const std::size_t count = short_.size();
      std::vector<ShortEdge> left;
      take_in_batches(
          context_, short_.size(), lists_,
          [&](std::size_t k, int worker) { return step_of(short_[k], scratch_[static_cast<std::size_t>(worker)]); },
          [&](std::size_t k, const ContractionStep& step) {
            if (step.is_gone) return;
            if (step.contraction) {
              lists_.contract(step.contraction->from, step.contraction->to);
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
    std::uint32_t looked = 0;  ///< ShrinkingLists::contractions() when it was looked at in vain
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

  /// Up to which length an edge may be contracted for what it is a side of, in voxels.
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

  /// Whether an edge goes from the rim of a sheet, or from where one comes to a seam, to the end of a seam next to the
  /// surface: in a corner of the solid.
  [[nodiscard]] bool is_at_corner(std::uint32_t a, std::uint32_t b) const {
    constexpr double next_to = 2;  // voxels
    if (lists_.rank(a) > lists_.rank(b)) std::swap(a, b);
    const bool is_on_rim = lists_.rank(a) % ShrinkingLists::on_seam > 0;
    return is_on_rim && lists_.rank(a) < ShrinkingLists::end_of_seam * ShrinkingLists::on_seam && !is_on_curve_[b] &&
           lists_.rank(b) / ShrinkingLists::on_seam == ShrinkingLists::end_of_seam &&
           lists_.radius(b) < next_to * voxel_;
  }

  /// Whether the rim of a sheet would come to a seam that goes on: a notch in the sheet. Where a sheet has borders only
  /// it may be a ribbon in the middle of what is round, which is to become a curve.
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

  /// What is to be done with an edge.
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
    // Seams and curves stay before rims, these before the insides of sheets, and there what knows its two walls.
    const auto worth = [&](std::uint32_t v) { return std::pair(lists_.rank(v), lists_.angle(v) > 0); };
    if (std::tuple(worth(from), to) > std::tuple(worth(to), from)) std::swap(from, to);
    if (!lists_.may_contract(from, to, scratch)) {
      std::swap(from, to);
      if (is_at_corner(from, to) || !lists_.may_contract(from, to, scratch)) return step;
    }
    step.contraction = {from, to};
    return step;
  }

  ShrinkingLists lists_;
  std::vector<LinkScratch> scratch_;  ///< of each thread
  double voxel_;
  ShortLengths lengths_;
  std::vector<bool> is_on_curve_;
  std::vector<Edge> crumbs_, slivers_;  ///< sides of these, sorted
  const Context& context_;
  std::vector<ShortEdge> short_;
};

}  // namespace

bool contract_short(AxisLists& lists, const Incidence& incidence, const Surface& surface, double voxel,
                    const ShortLengths& lengths, const Context& context) {
  return ShortEdges(lists, incidence, surface, voxel, lengths, context).run();
}

}  // namespace blum::detail
