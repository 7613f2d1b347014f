// Blum: onto which neighbour a vertex may move, and how far the surface moves then. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solid/clean/shrinking_surface.hpp"

namespace blum::detail {

/// A way for a vertex to go.
struct VertexCollapse {
  double cost = 0;       ///< of two the one with the lower one is taken
  double deviation = 0;  ///< bound on how far the new triangles are from the mesh at first, and it from them
  std::uint32_t target = 0;
  std::size_t onto = 0;  ///< the target's place in the ring
};

/// A way for a flat triangle to go: turning its longest side.
struct EdgeFlip {
  EdgePair edge;
  double cost = 0;
  double deviation = 0;
  bool is_possible = false;
};

class CollapseSearch {
 public:
  /// @param deviations  of each triangle: how far it is from the mesh at first, at most, and that from it.
  CollapseSearch(const ShrinkingSurface& mesh, std::span<const double> deviations, double tolerance)
      : mesh_(mesh), deviations_(deviations), tolerance_(tolerance) {}

  /// The ways that keep the bounds within the tolerance and make no worse triangles, by rising cost, then target.
  /// Neither the link condition nor contacts are looked at. The list and the star last until the next call.
  [[nodiscard]] std::span<const VertexCollapse> find(std::uint32_t v);
  [[nodiscard]] const Star& star() const { return star_; }

  /// The same of turning the longest side of a triangle.
  [[nodiscard]] EdgeFlip find_flip(std::uint32_t t) const;

 private:
  /// What there is to know of a triangle at the vertex before it goes.
  struct Side {
    Vec3d normal;
    double height = 0;
    bool is_needle = false;
  };
  struct Shape {
    bool is_allowed = false;
    double quality = 0;  ///< 1 where all triangles are equilateral
  };

  [[nodiscard]] bool is_needle(const Vec3d& a, const Vec3d& b, const Vec3d& c) const;
  void look_at_star(std::uint32_t v);
  void choose_targets();
  [[nodiscard]] double bound(std::size_t onto, double budget);
  [[nodiscard]] double bound_along_crease(double limit) const;
  [[nodiscard]] Shape shape(std::uint32_t v, std::size_t onto) const;
  [[nodiscard]] bool folds(std::uint32_t v, std::size_t side, const Vec3d& normal) const;

  const ShrinkingSurface& mesh_;
  std::span<const double> deviations_;
  double tolerance_;
  Star star_;
  std::vector<Vec3d> around_;   ///< the ring, relative to the vertex
  std::vector<Vec3d> rotated_;  ///< the same from a target on
  std::vector<Side> sides_;
  std::vector<std::size_t> targets_;
  std::vector<VertexCollapse> found_;
  double deviation_ = 0;     ///< the largest one of the star's triangles
  double least_height_ = 0;  ///< of these
};

}  // namespace blum::detail
