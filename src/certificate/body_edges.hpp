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
/// Limits of the cost of pushing an edge inside. Without limits, the check of edges along a hole without width would
/// hardly end if the tolerance is small.
struct PushBudget {
  int moves = 64;                                               ///< number of points that may be moved
  std::size_t looks = std::numeric_limits<std::size_t>::max();  ///< number of points whose depth may be computed
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
  /// Returns the largest distance by which an edge may leave the body and still be pushed inside.
  [[nodiscard]] double corner() const { return corner_; }

  /// Returns true if a segment is known to lie inside the body without touching its boundary.
  [[nodiscard]] bool is_inside(const Stop& a, const Stop& b) const {
    if (!(a.depth > 0 && b.depth > 0)) return false;
    return a.depth + b.depth >= length(b.at - a.at) || solid_.is_clear(a.at, b.at, body_);
  }

  /// Returns a point of a segment that is furthest outside the body, up to a factor of 1.25. If no point is outside by
  /// more than `allowed`, any point may be returned. A ball around a point inside, with the point's depth as radius,
  /// lies in the body. So only the parts between such balls are searched. In a thin wall these parts are many, so each
  /// part is first tested against the boundary.
  /// @param looks  number of points that may still be examined; it is reduced. Returns nullopt if they do not suffice.
  [[nodiscard]] std::optional<Stop> furthest_out(const Stop& a, const Stop& b, double allowed,
                                                 std::size_t& looks) const {
    constexpr double nearly = 1.25;  // only points that may be further out by this factor are searched
    Stop worst = a.depth < b.depth ? a : b;
    if (is_inside(a, b)) return worst;
    std::vector<std::pair<Stop, Stop>> stack{{a, b}};
    while (!stack.empty()) {
      const auto [p, q] = stack.back();
      stack.pop_back();
      const double gap = length(q.at - p.at);
      // The left side is twice the least depth that a point between p and q can have.
      if (p.depth + q.depth - gap >= 2 * std::min(-allowed, nearly * worst.depth)) continue;
      const double begin = std::max(p.depth, 0.0);
      const double end = gap - std::max(q.depth, 0.0);
      Stop middle{p.at + (q.at - p.at) * ((begin + end) / (2 * gap)), 0};
      if (middle.at == p.at || middle.at == q.at) continue;
      // Along an edge of the solid, balls are small, but most parts of the segment do not meet the boundary.
      if (p.depth > 0 && q.depth > 0 && solid_.is_clear(p.at, q.at, body_)) continue;
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
  /// Returns the furthest point without a limit on the number of examined points.
  [[nodiscard]] Stop furthest_out(const Stop& a, const Stop& b, double allowed) const {
    std::size_t looks = PushBudget().looks;
    return *furthest_out(a, b, allowed, looks);
  }

  /// Returns true if a segment that leaves the body can be pushed into it. The point furthest out is moved to the other
  /// side of the closest surface point, and both halves are tested again. At an edge of the solid, pushing soon
  /// succeeds. Across a gap, pushing never succeeds.
  /// @param budget  is reduced by the moves and looks used.
  /// @param way     the moved points are appended, in order from a to b.
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
  /// Returns a point as deep inside as `out` is outside, or, in thin parts, a quarter as deep. If neither point is
  /// inside, returns the closest surface point.
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
