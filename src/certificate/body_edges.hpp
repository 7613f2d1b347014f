// Blum: how edges of an axis lie in a body, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "blum/core/vec3.hpp"
#include "certificate/solid_oracle.hpp"

namespace blum::verifier {

inline constexpr double corner_of_diagonal = 1.0 / 64;
/// What it may cost to push an edge in. Edges along a hole of no width take for ever where little is allowed.
struct PushBudget {
  int moves = 64;                                               ///< points of it that may be moved
  std::size_t looks = std::numeric_limits<std::size_t>::max();  ///< points of it whose depth is asked for
};

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

  /// Whether a segment is known to meet no boundary.
  [[nodiscard]] bool is_inside(const Stop& a, const Stop& b) const {
    if (!(a.depth > 0 && b.depth > 0)) return false;
    return a.depth + b.depth >= length(b.at - a.at) || solid_.is_clear(a.at, b.at, body_);
  }

  /// The point of a segment that is furthest out, as far as that is more than is allowed. A ball as large as a point is
  /// deep lies in the body, so that only what is between such balls is left to ask about. In a thin wall these are
  /// many: so first it is asked whether the segment meets the boundary at all.
  /// @param looks  how many points may be asked for yet; nullopt where these are not enough.
  [[nodiscard]] std::optional<Stop> furthest_out(const Stop& a, const Stop& b, double allowed,
                                                 std::size_t& looks) const {
    constexpr double nearly = 1.25;  // enough of what is too much anyway
    Stop worst = a.depth < b.depth ? a : b;
    if (is_inside(a, b)) return worst;
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
      if (looks == 0) return std::nullopt;
      --looks;
      const Stop& known = std::abs(p.depth) > std::abs(q.depth) ? p : q;
      middle.depth = solid_.depth_beside(middle.at, body_, known.at, known.depth, allowed / 2);
      if (middle.depth < worst.depth) worst = middle;
      stack.emplace_back(p, middle);
      stack.emplace_back(middle, q);
    }
    return worst;
  }
  /// The same however many it takes.
  [[nodiscard]] Stop furthest_out(const Stop& a, const Stop& b, double allowed) const {
    std::size_t looks = PushBudget().looks;
    return *furthest_out(a, b, allowed, looks);
  }

  /// Whether a segment that leaves the body can be pushed into it: the point that is furthest out goes through the
  /// closest point of the surface, and both parts are asked again. Past an edge of the solid that soon succeeds; across
  /// a gap it never does.
  /// @param budget  is what is left of it afterwards.
  /// @param way     is given the moved points, from a to b.
  [[nodiscard]] bool can_be_pushed_in(const Stop& a, const Stop& b, PushBudget& budget, std::vector<Vec3d>& way) const {
    const std::optional<Stop> worst = furthest_out(a, b, allowed_, budget.looks);
    if (!worst) return false;
    if (-worst->depth <= allowed_) return true;
    if (budget.moves-- <= 0) return false;
    const Stop moved = pushed_in(*worst);
    if (!can_be_pushed_in(a, moved, budget, way)) return false;
    way.push_back(moved.at);
    return can_be_pushed_in(moved, b, budget, way);
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

/// An edge that leaves its body, and the points between its ends over which it can run inside of it.
struct PushedEdge {
  std::uint32_t edge = 0;
  std::vector<Vec3d> way;
};

}  // namespace blum::verifier
