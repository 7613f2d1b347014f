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

/// Balls in a tree over the boxes of their centres. The compiler vectorizes the bounds of a node's four children.
class BallUnion {
 public:
  /// @throws Cancelled.
  BallUnion(const std::vector<Ball>& balls, const Context& context);

  /// Returns the distance of a point outside the union from the union. The distance is the least difference between the
  /// distance from a centre and the ball's radius. In the union, the function returns some value of at most 0. The
  /// search starts with ball `first`, which costs less if that ball is nearly the closest. `first` is set to the
  /// closest ball found.
  [[nodiscard]] double gap(const Vec3d& p, std::uint32_t& first) const;

  /// The balls that contained previous points, the last one first. They often contain the next point, too.
  using Holders = std::array<std::uint32_t, 6>;
  /// Returns true if a point lies in a ball, deeper than `margin`.
  /// @param holders  the balls to try first; updated.
  [[nodiscard]] bool holds(const Vec3d& p, double margin, Holders& holders) const;

 private:
  static constexpr std::size_t width = 4;
  using Four = std::array<float, width>;

  /// Data of up to four children: the box of a child's centres, the largest radius, and a linear bound of the radii in
  /// the box. The linear bound matters in sheets that lead to an edge of the solid, where radii change as fast as the
  /// position.
  struct Node {
    std::array<Four, 3> middle{}, half{};  ///< of the boxes
    Four squared_reach{};                  ///< half of the diagonal, squared
    std::array<Four, 3> slope{};
    Four largest{};                            ///< largest radius
    Four radius{};                             ///< each radius is at most this + slope * (centre - middle)
    std::array<std::uint32_t, width> first{};  ///< first ball; a node if the child has no balls
    std::array<std::uint32_t, width> count{};  ///< number of balls
    std::size_t children = 0;
  };

  std::uint32_t add_node(const BoxHierarchy& tree, const std::vector<BoxHierarchy::Places>& places,
                         const std::vector<double>& largest, std::uint32_t index);
  void set_child(Node& node, std::size_t k, const Box3& box, const BoxHierarchy::Places& places, double largest) const;
  /// Fits the slope of the radii of consecutive balls by least squares, with lengths in units of `size_`. Returns 0 if
  /// the radii do not follow a plane.
  [[nodiscard]] Vec3d slope_of(const BoxHierarchy::Places& places) const;
  [[nodiscard]] double gap_to(const Vec3d& p, std::uint32_t place) const {
    return length(p - balls_[place].centre) - balls_[place].radius;
  }
  /// Returns lower bounds of the gaps to the balls below each child, up to rounding.
  [[nodiscard]] static Four bounds_of(const Node& node, const std::array<float, 3>& at);
  /// Calls visit(ball) for the balls that may have a gap below the least gap so far. visit() returns the new least gap.
  template <class Visit>
  void search(const Vec3d& p, double least, const Visit& visit) const;

  std::vector<Ball> balls_;  ///< in the tree's order
  std::vector<Node> nodes_;
  // Nodes store lengths relative to `origin_`, in units of `size_`, so that float32 suffices.
  Vec3d origin_;
  double size_ = 1;
  double slack_ = 0;  ///< largest rounding error of bounds near the balls
};

}  // namespace blum::verifier
