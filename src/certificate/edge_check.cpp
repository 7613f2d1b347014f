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

/// What is found of some of the edges.
struct Findings {
  EdgeCheck check;
  double allowed = 0;  ///< for the worst
  std::vector<PushedEdge> ways;

  void add(const Findings& other) {
    ways.insert(ways.end(), other.ways.begin(), other.ways.end());
    check.pushed += other.check.pushed;
    check.pushed_by = std::max(check.pushed_by, other.check.pushed_by);
    check.outside += other.check.outside;
    if (!(other.check.outside_by > check.outside_by)) return;
    check.outside_by = other.check.outside_by;
    check.where = other.check.where;
    allowed = other.allowed;
  }
};

/// Looks at one edge.
Findings look_at(std::uint32_t edge, const Stop& a, const Stop& b, const BodyEdges& body, bool may_push) {
  PushBudget budget;
  std::vector<Vec3d> way;
  Findings found;
  const Stop worst = body.furthest_out(a, b, body.allowed());
  if (-worst.depth <= body.allowed()) return found;
  may_push = may_push && -worst.depth <= body.corner() && std::min(a.depth, b.depth) >= -body.allowed();
  if (may_push && body.can_be_pushed_in(a, b, budget, way)) {
    found.check.pushed = 1;
    found.check.pushed_by = -worst.depth;
    found.ways.push_back({edge, std::move(way)});
    return found;
  }
  found.check.outside = 1;
  found.check.outside_by = -worst.depth;
  found.check.where = worst.at;
  found.allowed = body.allowed();
  return found;
}

std::string explained(const EdgeCheck& check, double allowed) {
  return "of the " + count_text(check.edges) + " edges of the axis " + count_text(check.outside) +
         " leave the solid between their ends, by up to " + rounded_text(check.outside_by) + " at " +
         verifier::place_text(check.where) + " (allowed: " + rounded_text(allowed) + ")";
}

}  // namespace

EdgeCheck check_edges(const MedialView& axis, const Incidence& incidence, const KnownSolid& solid,
                      const std::vector<Location>& locations, const AxisParts& parts, double factor,
                      std::vector<PushedEdge>& pushed, std::vector<std::string>& mismatches, const Context& context) {
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
          look_at(static_cast<std::uint32_t>(e), stop(a), stop(b), {*solid.solid, body, allowed[body]}, slack == 0));
    }
  });
  Findings all;
  for (const Findings& part : found) all.add(part);
  pushed = std::move(all.ways);
  EdgeCheck check = all.check;
  check.edges = edges.size();
  check.pushed_by /= factor;
  check.outside_by /= factor;
  check.where = check.where / factor;
  check.tolerance = *std::max_element(allowed.begin(), allowed.end()) / factor;
  check.holds = check.outside == 0;
  if (!check.holds) mismatches.push_back(explained(check, all.allowed / factor));
  return check;
}

}  // namespace blum::verifier
