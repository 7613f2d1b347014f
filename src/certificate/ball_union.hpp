// Blum: the union of the balls of a medial axis, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
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

/// Balls in a tree of the boxes of their centres, four to a node, whose bounds compilers make in one operation each.
class BallUnion {
 public:
  /// @throws Cancelled.
  BallUnion(const std::vector<Ball>& balls, const Context& context);

  /// The least of distance to the centre - radius, over all balls, where that is above 0: the distance from the union;
  /// something not above 0 in the union. Balls are tried from
  /// `first` on, which costs less where it is nearly the best, and holds the best one afterwards.
  [[nodiscard]] double gap(const Vec3d& p, std::uint32_t& first) const;

  /// The balls that held the points before, the last one first: often they hold the next one, too.
  using Holders = std::array<std::uint32_t, 6>;
  /// Whether a point lies in a ball, at least `margin` from its surface. @param holders  where to begin; are changed.
  [[nodiscard]] bool holds(const Vec3d& p, double margin, Holders& holders) const;

 private:
  static constexpr std::size_t width = 4;
  using Four = std::array<float, width>;

  /// Of each child the box of its centres, the largest radius, and radii as they rise along the box: those of sheets
  /// that lead to an edge of the solid rise as fast as the distance from the surface beside it does.
  struct Node {
    std::array<Four, 3> middle{}, half{};  ///< of the box
    Four squared_reach{};                  ///< of half of its diagonal
    std::array<Four, 3> slope{};
    Four largest{};                            ///< radius
    Four radius{};                             ///< no ball has more than this + slope * (centre - middle)
    std::array<std::uint32_t, width> first{};  ///< ball, or node where there are no balls
    std::array<std::uint32_t, width> count{};  ///< balls
    std::size_t children = 0;
  };

  std::uint32_t add_node(const BoxHierarchy& tree, const std::vector<BoxHierarchy::Places>& places,
                         const std::vector<double>& largest, std::uint32_t index);
  void set_child(Node& node, std::size_t k, const Box3& box, const BoxHierarchy::Places& places, double largest) const;
  /// How the radii of some balls rise, by least squares, in units of a size; 0 where they rise along no plane.
  [[nodiscard]] Vec3d slope_of(const BoxHierarchy::Places& places) const;
  [[nodiscard]] double gap_to(const Vec3d& p, std::uint32_t place) const {
    return length(p - balls_[place].centre) - balls_[place].radius;
  }
  /// No more than the gaps to the balls below each child, but for rounding.
  [[nodiscard]] static Four bounds_of(const Node& node, const std::array<float, 3>& at);
  /// Calls visit(ball) for the balls of nodes that may have a gap below the least one so far, which it returns.
  template <class Visit>
  void search(const Vec3d& p, double least, const Visit& visit) const;

  std::vector<Ball> balls_;  ///< in the tree's order
  std::vector<Node> nodes_;
  // The numbers of nodes are lengths from an origin, in units of a size, so that float32 has room for them.
  Vec3d origin_;
  double size_ = 1;
  double slack_ = 0;  ///< what bounds near the balls may be too large by, for rounding
};

}  // namespace blum::verifier
