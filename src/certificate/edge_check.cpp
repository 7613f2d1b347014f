#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "blum/complex/incidence.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/core/parallel.hpp"
#include "certificate/checks.hpp"

namespace blum::verifier {
namespace {

constexpr double corner_of_diagonal = 1.0 / 64;
/// Of what vertices are allowed: an edge along the surface is asked about as often as this goes into it.
constexpr double more_for_edges = 10;

/// A point, and how deep it lies in a body.
struct Stop {
  Vec3d at;
  double depth = 0;
};

/// What edges are asked about.
class BodyEdges {
 public:
  BodyEdges(const SolidOracle& solid, std::uint32_t body, double allowed)
      : solid_(solid),
        body_(body),
        allowed_(allowed),
        corner_(std::max(corner_of_diagonal * solid.diagonal(body), solid.grain() / 2)) {}

  [[nodiscard]] double allowed() const { return allowed_; }
  /// How far out an edge may be that can be pushed in.
  [[nodiscard]] double corner() const { return corner_; }

  /// The point of a segment that is furthest out, as far as that is more than is allowed. A ball as large as a point is
  /// deep lies in the body, so that only what is between such balls is left to ask about.
  [[nodiscard]] Stop furthest_out(const Stop& a, const Stop& b, double allowed) const {
    constexpr double nearly = 1.25;  // enough of what is too much anyway
    Stop worst = a.depth < b.depth ? a : b;
    std::vector<std::pair<Stop, Stop>> stack{{a, b}};
    while (!stack.empty()) {
      const auto [p, q] = stack.back();
      stack.pop_back();
      const double gap = length(q.at - p.at);
      // The least depth that distances leave room for is half of this.
      if (p.depth + q.depth - gap >= 2 * std::min(-allowed, nearly * worst.depth)) continue;
      const double begin = std::max(p.depth, 0.0);
      const double end = gap - std::max(q.depth, 0.0);
      Stop middle{p.at + (q.at - p.at) * ((begin + end) / (2 * gap)), 0};
      if (middle.at == p.at || middle.at == q.at) continue;
      const Stop& known = std::abs(p.depth) > std::abs(q.depth) ? p : q;
      middle.depth = solid_.depth_beside(middle.at, body_, known.at, known.depth, allowed / 2);
      if (middle.depth < worst.depth) worst = middle;
      stack.emplace_back(p, middle);
      stack.emplace_back(middle, q);
    }
    return worst;
  }

  /// Whether a segment that leaves the body can be pushed into it: the point that is furthest out goes through the
  /// closest point of the surface, and both parts are asked again. Past an edge of the solid that soon succeeds; across
  /// a gap it never does.
  /// @param moves  how many points may be moved yet.
  [[nodiscard]] bool can_be_pushed_in(const Stop& a, const Stop& b, int& moves) const {
    const Stop worst = furthest_out(a, b, allowed_);
    if (-worst.depth <= allowed_) return true;
    if (moves-- <= 0) return false;
    const Stop moved = pushed_in(worst);
    return can_be_pushed_in(a, moved, moves) && can_be_pushed_in(moved, b, moves);
  }

 private:
  /// A point as far inside as one is outside, or less far in where the body is thin.
  [[nodiscard]] Stop pushed_in(const Stop& out) const {
    const Vec3d foot = solid_.closest_point(out.at, body_);
    for (const double far : {1.0, 0.25}) {
      const Stop in{foot + (foot - out.at) * far, solid_.depth(foot + (foot - out.at) * far, body_)};
      if (in.depth > 0) return in;
    }
    return {foot, 0};
  }

  const SolidOracle& solid_;
  std::uint32_t body_;
  double allowed_;
  double corner_;
};

/// What is found of some of the edges.
struct Findings {
  EdgeCheck check;
  double allowed = 0;  ///< for the worst

  void add(const Findings& other) {
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
Findings look_at(const Stop& a, const Stop& b, const BodyEdges& body, bool may_push) {
  int moves = 64;
  Findings found;
  const Stop worst = body.furthest_out(a, b, body.allowed());
  if (-worst.depth <= body.allowed()) return found;
  may_push = may_push && -worst.depth <= body.corner() && std::min(a.depth, b.depth) >= -body.allowed();
  if (may_push && body.can_be_pushed_in(a, b, moves)) {
    found.check.pushed = 1;
    found.check.pushed_by = -worst.depth;
    return found;
  }
  found.check.outside = 1;
  found.check.outside_by = -worst.depth;
  found.check.where = worst.at;
  found.allowed = body.allowed();
  return found;
}

std::string explained(const EdgeCheck& check, double allowed) {
  const auto& [x, y, z] = check.where;
  return "of the " + count_text(check.edges) + " edges of the axis " + count_text(check.outside) +
         " leave the solid between their ends, by up to " + rounded_text(check.outside_by) + " at " + rounded_text(x) +
         " " + rounded_text(y) + " " + rounded_text(z) + " (allowed: " + rounded_text(allowed) + ")";
}

}  // namespace

EdgeCheck check_edges(const MedialView& axis, const KnownSolid& solid, const std::vector<Location>& locations,
                      const AxisParts& parts, double factor, std::vector<std::string>& mismatches,
                      const Context& context) {
  constexpr std::size_t grain = 256;
  const Incidence incidence(axis.cells(), context);
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
      found[range.begin / grain].add(look_at(stop(a), stop(b), {*solid.solid, body, allowed[body]}, slack == 0));
    }
  });
  Findings all;
  for (const Findings& part : found) all.add(part);
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
