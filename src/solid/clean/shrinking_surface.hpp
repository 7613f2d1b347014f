// Blum: a closed surface of triangles that loses vertices. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// The triangles around a vertex, in order. Triangle k has the vertex, ring[k] and ring[k + 1]; the last one has
/// ring[0].
struct Star {
  std::vector<std::uint32_t> ring;
  std::vector<std::uint32_t> triangles;
};

/// An edge and its two triangles: `left` has a, b, apex_left and `right` has b, a, apex_right, in this order.
struct EdgePair {
  std::uint32_t a = 0, b = 0;
  std::uint32_t left = 0, right = 0;
  std::uint32_t apex_left = 0, apex_right = 0;
};

/// A closed, oriented, manifold surface. Its triangles keep their numbers while vertices are removed and edges flipped.
class ShrinkingSurface {
 public:
  /// @param mesh  closed, oriented and manifold; its vertices must stay in place.
  explicit ShrinkingSurface(const MeshView& mesh);

  [[nodiscard]] const Vec3d& point(std::uint32_t v) const { return points_[v]; }
  [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }
  [[nodiscard]] const Triangle& triangle(std::uint32_t t) const { return triangles_[t]; }
  [[nodiscard]] bool is_gone(std::uint32_t t) const { return triangles_[t][0] == triangles_[t][1]; }
  [[nodiscard]] std::size_t triangles_left() const { return left_; }
  [[nodiscard]] std::span<const std::uint32_t> triangles_at(std::uint32_t v) const { return at_[v]; }
  [[nodiscard]] std::array<Vec3d, 3> corners(std::uint32_t t) const {
    return {points_[triangles_[t][0]], points_[triangles_[t][1]], points_[triangles_[t][2]]};
  }

  /// Finds the star of a vertex.
  /// @param out  is overwritten; its memory is reused.
  void find_star(std::uint32_t v, Star& out) const;
  [[nodiscard]] bool has_edge(std::uint32_t a, std::uint32_t b) const;
  /// Returns the side of a triangle that is opposite to one of its corners.
  [[nodiscard]] EdgePair opposite_edge(std::uint32_t t, std::uint32_t corner) const;

  /// Returns true if moving the middle of a star onto a corner of its ring gives a homeomorphic surface: the link
  /// condition.
  [[nodiscard]] bool may_collapse(const Star& star, std::size_t onto) const;
  /// Performs this collapse.
  /// @param v  the middle of the star.
  void collapse(std::uint32_t v, const Star& star, std::size_t onto);
  /// Flips an edge, which then joins the two apexes. No edge may join these before. `left` becomes apex_left, a,
  /// apex_right and `right` becomes apex_right, b, apex_left.
  void flip(const EdgePair& edge);

 private:
  void take_out(std::uint32_t v, std::uint32_t triangle);

  std::span<const Vec3d> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::vector<std::uint32_t>> at_;
  std::size_t left_ = 0;
};

[[nodiscard]] double longest_side(const Vec3d& a, const Vec3d& b, const Vec3d& c);
/// Returns the height of a triangle above its longest side; 0 if that side is a point.
[[nodiscard]] double least_height(const Vec3d& a, const Vec3d& b, const Vec3d& c);

}  // namespace blum::detail
