// Blum: the union of the balls of a medial axis, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "certificate/box_hierarchy.hpp"

namespace blum::verifier {

struct Ball {
  Vec3d centre;
  double radius = 0;
};

/// Balls in a tree of the boxes of their centres.
class BallUnion {
 public:
  /// @throws Cancelled.
  BallUnion(const std::vector<Ball>& balls, const Context& context);

  /// The least of distance to the centre - radius, over all balls, where that is above 0: the distance from the union;
  /// something not above 0 in the union. Balls are tried from
  /// `first` on, which costs less where it is nearly the best, and holds the best one afterwards.
  [[nodiscard]] double gap(const Vec3d& p, std::uint32_t& first) const;

  /// Whether a point lies in a ball, at least `margin` from its surface.
  [[nodiscard]] bool holds(const Vec3d& p, double margin) const;

 private:
  [[nodiscard]] double gap_to(const Vec3d& p, std::uint32_t place) const {
    return length(p - balls_[place].centre) - balls_[place].radius;
  }
  /// No more than the gaps to the balls below two siblings.
  [[nodiscard]] Two gaps(const Vec3d& p, std::uint32_t first_child) const;

  std::vector<Ball> balls_;  ///< in the tree's order
  BoxHierarchy tree_;
  std::vector<Two> largest_;  ///< radii below siblings
};

}  // namespace blum::verifier
