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

/// The triangles around a vertex, in order. Triangle k has the corners vertex, ring[k] and ring[k + 1]. For the last
/// triangle, ring[0] follows the last ring vertex.
struct Star {
  std::vector<std::uint32_t> ring;
  std::vector<std::uint32_t> triangles;
};

/// An edge and its two triangles. The corners in order are a, b, apex_left for `left` and b, a, apex_right for `right`.
struct EdgePair {
  std::uint32_t a = 0, b = 0;
  std::uint32_t left = 0, right = 0;
  std::uint32_t apex_left = 0, apex_right = 0;
};

/// A closed, oriented, manifold surface.
/// Triangles keep their indices when vertices are removed and edges are flipped.
class ShrinkingSurface {
 public:
  /// @param mesh  closed, oriented and manifold. Its vertices must stay valid and unchanged.
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
  /// @param out  is overwritten, with its memory reused.
  void find_star(std::uint32_t v, Star& out) const;
  [[nodiscard]] bool has_edge(std::uint32_t a, std::uint32_t b) const;
  /// Returns the side of triangle `t` opposite to one of its corners, with `t` as `left`.
  [[nodiscard]] EdgePair opposite_edge(std::uint32_t t, std::uint32_t corner) const;

  /// Returns true if the link condition holds: moving the centre of a star onto corner `onto` of its ring gives a
  /// homeomorphic surface.
  [[nodiscard]] bool may_collapse(const Star& star, std::size_t onto) const;
  /// Performs the collapse that may_collapse() allows.
  /// @param v  the centre of the star.
  void collapse(std::uint32_t v, const Star& star, std::size_t onto);
  /// Flips an edge, so that it joins the two apexes. Before the flip, no edge may join the apexes. `left` becomes
  /// apex_left, a, apex_right; `right` becomes apex_right, b, apex_left.
  void flip(const EdgePair& edge);

 private:
  void take_out(std::uint32_t v, std::uint32_t triangle);

  std::span<const Vec3d> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::vector<std::uint32_t>> at_;
  std::size_t left_ = 0;
};

[[nodiscard]] double longest_side(const Vec3d& a, const Vec3d& b, const Vec3d& c);
/// Returns the height of a triangle above its longest side; 0 if all corners coincide.
[[nodiscard]] double least_height(const Vec3d& a, const Vec3d& b, const Vec3d& c);

}  // namespace blum::detail
