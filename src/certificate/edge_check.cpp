#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "blum/complex/incidence.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "certificate/body_edges.hpp"
#include "certificate/checks.hpp"

namespace blum::verifier {
namespace {

/// Findings about some of the edges.
struct Findings {
  EdgeCheck check;
  double allowed = 0;  ///< tolerance at the worst edge
  EdgeWays ways;

  void add(const Findings& other) {
    ways.pushed.insert(ways.pushed.end(), other.ways.pushed.begin(), other.ways.pushed.end());
    ways.grazing.insert(ways.grazing.end(), other.ways.grazing.begin(), other.ways.grazing.end());
    if (check.across == 0) check.across_at = other.check.across_at;
    check.across += other.check.across;
    check.undecided += other.check.undecided;
    check.pushed += other.check.pushed;
    check.pushed_by = std::max(check.pushed_by, other.check.pushed_by);
    check.outside += other.check.outside;
    if (!(other.check.outside_by > check.outside_by)) return;
    check.outside_by = other.check.outside_by;
    check.where = other.check.where;
    allowed = other.allowed;
  }
};

/// Checks single edges.
class EdgeLook {
 public:
  EdgeLook(const SolidOracle& solid, std::uint32_t body, double allowed)
      : solid_(solid), body_(body), edges_(solid, body, allowed) {}

  [[nodiscard]] Findings look_at(std::uint32_t edge, const Stop& a, const Stop& b) const {
    Findings found;
    if (edges_.is_inside(a, b) || solid_.holds(a.at, b.at, body_)) return found;
    const bool may_push = solid_.slack() == 0;
    const Stop worst = edges_.furthest_out(a, b, edges_.allowed());
    if (-worst.depth <= edges_.allowed()) {
      if (-worst.depth > grazes * edges_.allowed()) found.ways.grazing.push_back(edge);
      look_for_gaps({a, b}, found);
      return found;
    }
    PushBudget budget;
    std::vector<Vec3d> way;
    if (may_push && -worst.depth <= edges_.corner() && std::min(a.depth, b.depth) >= -edges_.allowed() &&
        edges_.can_be_pushed_in(a, b, budget, way)) {
      found.check.pushed = 1;
      found.check.pushed_by = -worst.depth;
      std::vector<Stop> stops{a};
      for (const Vec3d& at : way) stops.push_back({at, solid_.depth(at, body_)});
      stops.push_back(b);
      look_for_gaps(stops, found);
      found.ways.pushed.push_back({edge, std::move(way)});
      return found;
    }
    found.check.outside = 1;
    found.check.outside_by = -worst.depth;
    found.check.where = worst.at;
    found.allowed = edges_.allowed();
    return found;
  }

 private:
  static constexpr double grazes = 1e-4;  ///< fraction of the tolerance that is more than rounding

  /// Searches for gaps of the solid. An edge that leaves the solid by at most the tolerance may still cross a gap of
  /// this width.
  void look_for_gaps(const std::vector<Stop>& way, Findings& found) const {
    constexpr double beside = 2;  // the middle of a gap is half its width from both walls
    for (std::size_t k = 0; k + 1 < way.size(); ++k) {
      if (edges_.is_inside(way[k], way[k + 1])) continue;
      const auto is_across = solid_.crosses_gap(way[k].at, way[k + 1].at, body_, beside * edges_.allowed());
      if (is_across == true) {
        found.check.across = 1;
        found.check.across_at = 0.5 * (way[k].at + way[k + 1].at);
        return;
      }
      if (!is_across) found.check.undecided = 1;
    }
  }

  const SolidOracle& solid_;
  std::uint32_t body_;
  BodyEdges edges_;
};

std::string explained(const EdgeCheck& check, double allowed) {
  return "of the " + count_text(check.edges) + " edges of the axis " + count_text(check.outside) +
         " leave the solid between their ends, by up to " + rounded_text(check.outside_by) + " at " +
         verifier::place_text(check.where) + " (allowed: " + rounded_text(allowed) + ")";
}

}  // namespace

EdgeCheck check_edges(const MedialView& axis, const Incidence& incidence, const KnownSolid& solid,
                      const std::vector<Location>& locations, const AxisParts& parts, double factor, EdgeWays& ways,
                      std::vector<std::string>& mismatches, const Context& context) {
  constexpr std::size_t grain = 256;
  const std::span<const std::array<std::uint32_t, 2>> edges = incidence.edges();
  std::vector<double> allowed = tolerances(solid);
  const double slack = solid.solid->slack();
  for (double& amount : allowed) amount = more_for_edges * amount + slack;
  std::vector<Findings> found(edges.size() / grain + 1);
  parallel_for(context, edges.size(), grain, "checking edges", [&](const WorkRange& range) {
    for (std::size_t e = range.begin; e < range.end; ++e) {
      const auto [a, b] = edges[e];
      if (!is_finite(axis.positions[a]) || !is_finite(axis.positions[b])) continue;
      const std::uint32_t body = parts.body_of[a];
      const auto stop = [&](std::uint32_t v) {
        const Vec3d& at = axis.positions[v];
        return Stop{at, locations[v].body == body ? locations[v].depth : solid.solid->depth(at, body)};
      };
      found[range.begin / grain].add(
          EdgeLook(*solid.solid, body, allowed[body]).look_at(static_cast<std::uint32_t>(e), stop(a), stop(b)));
    }
  });
  Findings all;
  for (const Findings& part : found) all.add(part);
  ways = std::move(all.ways);
  EdgeCheck check = all.check;
  check.edges = edges.size();
  check.pushed_by /= factor;
  check.outside_by /= factor;
  check.where = check.where / factor;
  check.across_at = check.across_at / factor;
  check.tolerance = *std::max_element(allowed.begin(), allowed.end()) / factor;
  check.holds = check.outside == 0 && check.across == 0;
  if (check.outside > 0) mismatches.push_back(explained(check, all.allowed / factor));
  if (check.across > 0) {
    mismatches.push_back("of the " + count_text(check.edges) + " edges of the axis " + count_text(check.across) +
                         " cross gaps of the solid that are narrower than the steps of the check, the first one at " +
                         verifier::place_text(check.across_at));
  }
  return check;
}

}  // namespace blum::verifier
