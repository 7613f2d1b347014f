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

/// Returns how often the segment from p to q crosses the triangle a, b, c. It is 1 or -1, depending on the side from
/// which the segment comes, or 0. Returns nullopt if the segment meets the border of the triangle, lies in its plane,
/// or ends in it.
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

/// Group of triangles that belong to no group. In queries, it stands for all groups.
inline constexpr std::uint32_t no_group = 0xffffffffU;

/// A line, and two directions across it. All three directions are unit vectors at right angles to each other.
struct ProbeLine {
  Vec3d point;
  Vec3d along, across, up;
};
/// Returns a line through a point, with direction number `attempt` of a fixed sequence. No direction is nearly parallel
/// to a plane of two coordinate axes.
[[nodiscard]] ProbeLine line_through(const Vec3d& point, std::uint32_t attempt);
/// Returns the infinite line through two points, directed from `from` to `to`.
[[nodiscard]] ProbeLine line_between(const Vec3d& from, const Vec3d& to);

/// A point where a line meets a triangle.
struct Crossing {
  double at = 0;  ///< position along the line from its point, mesh units
  std::uint32_t triangle = 0;
};

/// Triangles in a tree of boxes. The triangles may belong to groups. A query is about one group, or about all
/// triangles.
class TriangleSearch {
 public:
  struct Nearest {
    double distance = 0;
    std::uint32_t triangle = 0;
    /// Number of other triangles of the query whose closest points coincide with this one, up to rounding; nullopt if
    /// they are too many to count.
    std::optional<std::size_t> others;
    std::uint32_t other = 0;  ///< one of these triangles, if any
  };

  TriangleSearch() = default;
  /// @param groups  for each triangle; triangles of no_group are left out. If empty, all triangles are in group 0.
  /// @throws Cancelled.
  TriangleSearch(const MeshView& mesh, std::span<const std::uint32_t> groups, const Context& context);

  /// Returns the closest triangle of a group, or of all triangles for no_group. Exact up to rounding. The distance is
  /// HUGE_VAL if there are no triangles.
  [[nodiscard]] Nearest nearest(const Vec3d& p, std::uint32_t group = no_group) const;
  /// Returns the closest triangle faster, if a triangle of the group is known to be within the distance `within`.
  [[nodiscard]] Nearest nearest_within(const Vec3d& p, double within, std::uint32_t group) const;

  /// Finds the triangles of a group within a distance of a point.
  void find_within(const Vec3d& p, double distance, std::uint32_t group, std::vector<std::uint32_t>& found) const;

  /// Returns the closest point of the triangles of a group, if one of them is known to be within the distance `within`.
  /// Costs less than nearest_within().
  [[nodiscard]] Vec3d closest_point_within(const Vec3d& p, double within, std::uint32_t group) const;
  /// Returns the distance of the closest triangle of a group if it is at least `enough`. Otherwise returns a value
  /// below `enough`, which may be larger than the distance.
  [[nodiscard]] double distance_above(const Vec3d& p, double enough, std::uint32_t group) const;

  /// Finds the crossings of a line with all triangles; if `reach` is finite, at least with those near the line's first
  /// `reach`. Returns false if the line is too close to an edge to decide.
  [[nodiscard]] bool crossings(const ProbeLine& line, std::vector<Crossing>& found, double reach = HUGE_VAL) const;

  /// Finds the crossings of a segment with the triangles of a group. Only their positions are rounded, so the segment
  /// may pass edges at any distance. Returns false if exact_crossing() is undecided for a triangle.
  [[nodiscard]] bool exact_crossings(const Vec3d& from, const Vec3d& to, std::uint32_t group,
                                     std::vector<Crossing>& found) const;

  /// Returns true if no side of a triangle of the group pierces the given triangle. Also returns false if rounding
  /// leaves this open.
  [[nodiscard]] bool is_unpierced(const std::array<Vec3d, 3>& triangle, std::uint32_t group) const;

  [[nodiscard]] const Box3& bounds() const { return bounds_; }

 private:
  using Corners = std::array<Vec3d, 3>;

  /// A box along the mean normal of some triangles. It is flat if the triangles are, so that queries from far away
  /// visit few triangles.
  struct FlatBox {
    Vec3d origin;
    Mat3 axes;
    Box3 box;  ///< extent along `axes`, relative to `origin`
  };
  /// The flat boxes of two siblings in the tree. A sibling with too many triangles has its axis-parallel box instead.
  struct TwoFlatBoxes {
    std::array<Two, 3> origin{};
    std::array<std::array<Two, 3>, 3> axes{};
    TwoBoxes boxes;

    void set(std::size_t k, const FlatBox& flat);
  };
  /// Calls best = visit(place, closest point, squared distance) for the triangles of a group that may be closer than
  /// the best so far.
  template <class Visit>
  void search(const Vec3d& p, double best, std::uint32_t group, const Visit& visit) const;
  void make_flat_boxes(const Context& context);
  [[nodiscard]] static FlatBox flat_box(std::span<const Corners> triangles);
  [[nodiscard]] Two squared_bounds(const Vec3d& p, std::uint32_t first_child) const;
  BoxHierarchy tree_;
  std::vector<TwoFlatBoxes> flat_boxes_;  ///< for each pair of siblings in the tree
  std::vector<Corners> corners_;          ///< in the tree's order
  std::vector<std::uint32_t> triangles_;  ///< indices in the mesh, in the tree's order
  std::vector<std::uint32_t> groups_;     ///< in the tree's order
  Box3 bounds_;
};

/// Returns the distance of a point from a vertex, an edge or a triangle of a mesh; HUGE_VAL if the site does not exist.
[[nodiscard]] double distance_from_site(const MeshView& mesh, const SiteTable& sites, const Vec3d& p, SiteId site);

[[nodiscard]] inline std::array<Vec3d, 3> corners_of(const MeshView& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

/// Returns the point of a triangle that is closest to p. The triangle may be a segment or a point.
[[nodiscard]] Vec3d closest_point(const Vec3d& p, const std::array<Vec3d, 3>& corners);
/// Returns the squared distance of a point from a triangle, which may be a segment or a point.
[[nodiscard]] double squared_distance(const Vec3d& p, const std::array<Vec3d, 3>& corners);

}  // namespace blum::verifier
