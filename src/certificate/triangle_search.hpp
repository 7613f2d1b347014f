// Blum: closest points and crossings of triangles, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/orient3d.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "certificate/box_hierarchy.hpp"

namespace blum::verifier {

/// How often the way from p to q crosses the triangle a, b, c: 1 or -1 by the side that it comes from, or 0; nullopt
/// where it meets the border of the triangle, or runs in its plane, or ends in it.
[[nodiscard]] inline std::optional<int> exact_crossing(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p,
                                                       const Vec3d& q) {
  using detail::orient3d;
  const int from = orient3d(a, b, c, p);
  const int to = orient3d(a, b, c, q);
  if (from == to && from != 0) return 0;
  const int first = orient3d(p, q, a, b);
  const int second = orient3d(p, q, b, c);
  if (first * second < 0) return 0;
  const int third = orient3d(p, q, c, a);
  if (first * third < 0 || second * third < 0) return 0;
  if (from == 0 || to == 0 || first == 0 || second == 0 || third == 0) return std::nullopt;
  return to;
}

/// The same for all triangles that go with no group.
inline constexpr std::uint32_t no_group = 0xffffffffU;

/// A line, and two directions across it, all of length 1 and at right angles.
struct ProbeLine {
  Vec3d point;
  Vec3d along, across, up;
};
/// One of a fixed sequence of directions, none of them nearly along a plane of two axes.
[[nodiscard]] ProbeLine line_through(const Vec3d& point, std::uint32_t attempt);
/// From one point to another one.
[[nodiscard]] ProbeLine line_between(const Vec3d& from, const Vec3d& to);

/// Where a line meets a triangle.
struct Crossing {
  double at = 0;  ///< along the line, from its point; mesh units
  std::uint32_t triangle = 0;
};

/// Triangles in a tree of boxes. The triangles of a mesh may belong to groups, of which one at a time is asked.
class TriangleSearch {
 public:
  struct Nearest {
    double distance = 0;
    std::uint32_t triangle = 0;
    /// Of those asked of, how many more have their closest points at the same place, up to rounding; nullopt where
    /// these are too many to tell.
    std::optional<std::size_t> others;
    std::uint32_t other = 0;  ///< one of them, where there are any
  };

  TriangleSearch() = default;
  /// @param groups  of each triangle; those of no_group are left out. Empty: all triangles are in group 0.
  /// @throws Cancelled.
  TriangleSearch(const MeshView& mesh, std::span<const std::uint32_t> groups, const Context& context);

  /// The closest triangle of a group, or for no_group of all. Exact up to rounding. HUGE_VAL where there is none.
  [[nodiscard]] Nearest nearest(const Vec3d& p, std::uint32_t group = no_group) const;
  /// The same, and faster, where a triangle is known to be within a distance.
  [[nodiscard]] Nearest nearest_within(const Vec3d& p, double within, std::uint32_t group) const;

  /// The closest point of the triangles of a group, where one is known to be within a distance; costs less than
  /// nearest_within().
  [[nodiscard]] Vec3d closest_point_within(const Vec3d& p, double within, std::uint32_t group) const;
  /// The distance of the closest triangle of a group; where that is below `enough`, maybe more, but below it, too.
  [[nodiscard]] double distance_above(const Vec3d& p, double enough, std::uint32_t group) const;

  /// Finds all crossings of a line, those with triangles near its first `reach` at least; false if it comes too close
  /// to an edge to tell.
  [[nodiscard]] bool crossings(const ProbeLine& line, std::vector<Crossing>& found, double reach = HUGE_VAL) const;

  /// The same for a segment, triangles of a group and without rounding, but for the places: also where the segment runs
  /// beside edges, closer than rounding. False where it touches one.
  [[nodiscard]] bool exact_crossings(const Vec3d& from, const Vec3d& to, std::uint32_t group,
                                     std::vector<Crossing>& found) const;

  /// Whether no side of the triangles of a group comes through a triangle; false also where rounding leaves doubt.
  [[nodiscard]] bool is_unpierced(const std::array<Vec3d, 3>& triangle, std::uint32_t group) const;

  [[nodiscard]] const Box3& bounds() const { return bounds_; }

 private:
  using Corners = std::array<Vec3d, 3>;

  /// A box along the mean normal of some triangles: flat where they are, so that far queries reach few of them.
  struct FlatBox {
    Vec3d origin;
    Mat3 axes;
    Box3 box;  ///< from the origin, along the axes
  };
  /// Those of siblings, or their boxes where one of them has too many triangles for it.
  struct TwoFlatBoxes {
    std::array<Two, 3> origin{};
    std::array<std::array<Two, 3>, 3> axes{};
    TwoBoxes boxes;

    void set(std::size_t k, const FlatBox& flat);
  };
  /// Calls best = visit(place, closest point, its squared distance) for the triangles of a group that may be closer
  /// than the best.
  template <class Visit>
  void search(const Vec3d& p, double best, std::uint32_t group, const Visit& visit) const;
  void make_flat_boxes(const Context& context);
  [[nodiscard]] static FlatBox flat_box(std::span<const Corners> triangles);
  [[nodiscard]] Two squared_bounds(const Vec3d& p, std::uint32_t first_child) const;
  BoxHierarchy tree_;
  std::vector<TwoFlatBoxes> flat_boxes_;  ///< of siblings in the tree
  std::vector<Corners> corners_;          ///< in the tree's order
  std::vector<std::uint32_t> triangles_;  ///< of the mesh, in the tree's order
  std::vector<std::uint32_t> groups_;     ///< in the tree's order
  Box3 bounds_;
};

/// Distance of a point from a vertex, an edge or a triangle of a mesh; HUGE_VAL where there is no such site.
[[nodiscard]] double distance_from_site(const MeshView& mesh, const SiteTable& sites, const Vec3d& p, SiteId site);

[[nodiscard]] inline std::array<Vec3d, 3> corners_of(const MeshView& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

/// The point of a triangle, which may be a segment or a point, that is closest to a point.
[[nodiscard]] Vec3d closest_point(const Vec3d& p, const std::array<Vec3d, 3>& corners);
/// Squared distance of a point from a triangle, which may be a segment or a point.
[[nodiscard]] double squared_distance(const Vec3d& p, const std::array<Vec3d, 3>& corners);

}  // namespace blum::verifier
