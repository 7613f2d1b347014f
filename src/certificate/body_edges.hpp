// Blum: how edges of an axis lie in a body, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "blum/core/vec3.hpp"
#include "certificate/solid_oracle.hpp"

namespace blum::verifier {

inline constexpr double corner_of_diagonal = 1.0 / 64;
/// How many points of an edge may be moved to push it in.
inline constexpr int most_moves = 64;

/// A point, and how deep it lies in a body.
struct Stop {
  Vec3d at;
  double depth = 0;
};

/// What edges are asked about.
class BodyEdges {
 public:
  /// @param most_looks  points of edges whose depth is asked for, of all edges together; then none can be pushed in any
  ///                    more. Without it, edges along a hole of no width take for ever where little is allowed.
  BodyEdges(const SolidOracle& solid, std::uint32_t body, double allowed, std::size_t* most_looks = nullptr)
      : solid_(solid),
        body_(body),
        allowed_(allowed),
        looks_left_(most_looks),
        corner_(std::max(corner_of_diagonal * solid.diagonal(body), solid.grain() / 2)) {}

  [[nodiscard]] double allowed() const { return allowed_; }
  /// How far out an edge may be that can be pushed in.
  [[nodiscard]] double corner() const { return corner_; }

  /// The point of a segment that is furthest out, as far as that is more than is allowed. A ball as large as a point is
  /// deep lies in the body, so that only what is between such balls is left to ask about. In a thin wall these are
  /// many: so first it is asked whether the segment meets the boundary at all. Infinitely far out after the last look.
  [[nodiscard]] Stop furthest_out(const Stop& a, const Stop& b, double allowed) const {
    constexpr double nearly = 1.25;  // enough of what is too much anyway
    Stop worst = a.depth < b.depth ? a : b;
    if (a.depth > 0 && b.depth > 0) {
      if (a.depth + b.depth >= length(b.at - a.at) || solid_.is_clear(a.at, b.at, body_)) return worst;
    }
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
      if (looks_left_ != nullptr && *looks_left_ == 0) return {middle.at, -HUGE_VAL};
      if (looks_left_ != nullptr) --*looks_left_;
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
  /// @param way  is given the moved points, from a to b.
  [[nodiscard]] bool can_be_pushed_in(const Stop& a, const Stop& b, int& moves, std::vector<Vec3d>& way) const {
    const Stop worst = furthest_out(a, b, allowed_);
    if (-worst.depth <= allowed_) return true;
    if (worst.depth == -HUGE_VAL || moves-- <= 0) return false;
    const Stop moved = pushed_in(worst);
    if (!can_be_pushed_in(a, moved, moves, way)) return false;
    way.push_back(moved.at);
    return can_be_pushed_in(moved, b, moves, way);
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
  std::size_t* looks_left_;
  double corner_;
};

/// An edge that leaves its body, and the points between its ends over which it can run inside of it.
struct PushedEdge {
  std::uint32_t edge = 0;
  std::vector<Vec3d> way;
};

}  // namespace blum::verifier
