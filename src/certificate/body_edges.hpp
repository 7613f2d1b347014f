// Blum: edges of an axis in a body, for the verifier. SPDX-License-Identifier: Apache-2.0
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
/// Limits of the cost of pushing an edge inside. Edges along a hole of no width would take for ever if little is
/// allowed.
struct PushBudget {
  int moves = 64;                                               ///< points that may be moved
  std::size_t looks = std::numeric_limits<std::size_t>::max();  ///< points whose depth may be computed
};

/// A point and its depth in a body.
struct Stop {
  Vec3d at;
  double depth = 0;
};

/// Queries about the edges in one body.
class BodyEdges {
 public:
  BodyEdges(const SolidOracle& solid, std::uint32_t body, double allowed)
      : solid_(solid),
        body_(body),
        allowed_(allowed),
        corner_(std::max(corner_of_diagonal * solid.diagonal(body), solid.grain() / 2)) {}

  [[nodiscard]] double allowed() const { return allowed_; }
  /// Returns how far out an edge may be to be pushed inside.
  [[nodiscard]] double corner() const { return corner_; }

  /// Returns true if a segment is known to lie inside, without meeting the boundary.
  [[nodiscard]] bool is_inside(const Stop& a, const Stop& b) const {
    if (!(a.depth > 0 && b.depth > 0)) return false;
    return a.depth + b.depth >= length(b.at - a.at) || solid_.is_clear(a.at, b.at, body_);
  }

  /// Returns the point of a segment that is furthest out, to within a quarter. If no point is out by more than
  /// `allowed`, any point may be returned. Around each point, a ball with the point's depth as radius lies in the body.
  /// So only the parts between such balls are searched. In a thin wall these are many, so the segment is first tested
  /// against the boundary.
  /// @param looks  how many more points may be searched. Returns nullopt if they do not suffice.
  [[nodiscard]] std::optional<Stop> furthest_out(const Stop& a, const Stop& b, double allowed,
                                                 std::size_t& looks) const {
    constexpr double nearly = 1.25;  // points are searched only if they may be worse by this factor
    Stop worst = a.depth < b.depth ? a : b;
    if (is_inside(a, b)) return worst;
    std::vector<std::pair<Stop, Stop>> stack{{a, b}};
    while (!stack.empty()) {
      const auto [p, q] = stack.back();
      stack.pop_back();
      const double gap = length(q.at - p.at);
      // The left side is twice the least depth that is possible in between.
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
  /// Returns the same, with any number of points.
  [[nodiscard]] Stop furthest_out(const Stop& a, const Stop& b, double allowed) const {
    std::size_t looks = PushBudget().looks;
    return *furthest_out(a, b, allowed, looks);
  }

  /// Returns true if a segment that leaves the body can be pushed into it. The point furthest out is moved through the
  /// closest point of the surface, and both parts are tested again. Past an edge of the solid that soon succeeds.
  /// Across a gap it never does.
  /// @param budget  reduced to what is left.
  /// @param way     receives the moved points, from a to b.
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
  /// Returns a point as deep inside as `out` is outside, or a quarter as deep in thin parts, else the surface point.
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

/// An edge that leaves its body, and the points between its ends that keep it inside.
struct PushedEdge {
  std::uint32_t edge = 0;
  std::vector<Vec3d> way;
};

}  // namespace blum::verifier
