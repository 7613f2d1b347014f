// Blum: exact distances from the sites of a polyhedron. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/complex/index_rows.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"

namespace blum::voronoi {

/// Returns for each vertex of a SiteTable its edges, in ascending order.
[[nodiscard]] inline IndexRows edges_of_vertices(const SiteTable& table) {
  return detail::rows_of(table.edge_count(), table.vertex_count(),
                         [&](std::size_t edge) -> const Segment& { return table.edges()[edge]; });
}

/// Returns the positions of the other ends of edges at a vertex.
[[nodiscard]] inline std::vector<Vec3d> far_ends(const MeshView& mesh, const SiteTable& table, std::uint32_t v,
                                                 std::span<const std::uint32_t> edges) {
  std::vector<Vec3d> out;
  for (const std::uint32_t edge : edges) {
    const auto& [a, b] = table.edges()[edge];
    out.push_back(mesh.vertices[a == v ? b : a]);
  }
  return out;
}

/// An object that can be closest to a point: a triangle (a part of a face), a reflex edge or a reflex vertex.
struct Label {
  SiteKind kind = SiteKind::face;
  std::uint32_t index = 0;  ///< index of the triangle, edge or vertex

  [[nodiscard]] friend bool operator==(const Label&, const Label&) = default;
};

/// Number of all signs computed, and number of those that needed exact arithmetic.
struct SignCounts {
  std::size_t all = 0;
  std::size_t exact = 0;
};

/// The labels of a polyhedron, and exact signs of expressions about them, at points with double coordinates.
///
/// A label's domain contains the points that project onto the label. For a triangle, it is the prism between three
/// planes, one through each side and at a right angle to the triangle. For an edge, it is the slab between the two
/// planes through its ends at a right angle to the edge. The prisms of the edge's two triangles are excluded. For a
/// vertex v, it is the set of points q with (q - v) . (w - v) <= 0 for all edges v - w.
///
/// If a label is closest to a point, the point is in the label's domain. Signs are first computed in double with bounds
/// on all rounding. If the bounds leave a sign open, it is computed without rounding. If neighbouring labels share a
/// plane, the same expression gives its sign for both, so that they agree.
class SiteLabels {
 public:
  /// @param mesh, table, sites  all of the same polyhedron. They must outlive this object.
  SiteLabels(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites);

  [[nodiscard]] const std::vector<Label>& all() const { return all_; }
  /// Returns the site of a label. Faces are numbered first, then reflex edges, then reflex vertices.
  [[nodiscard]] std::uint32_t site_of(const Label& label) const;
  [[nodiscard]] std::size_t site_count() const;

  /// Returns on which side of a plane a point lies: 1, 0 or -1, with 1 on the side of the triangle. The plane is at a
  /// right angle to the triangle and contains its side k (from corner k to the next).
  [[nodiscard]] int side_of_triangle(std::uint32_t triangle, std::size_t k, const Vec3d& q) const;
  /// Returns on which side of a plane a point lies: 1, 0 or -1, with 1 on the side of the edge. The plane is at a right
  /// angle to the edge and contains one of its ends.
  /// @param end  0 or 1.
  [[nodiscard]] int side_of_end(std::uint32_t edge, std::size_t end, const Vec3d& q) const;
  /// Returns true if a point is in a label's domain, borders included.
  [[nodiscard]] bool is_in_domain(const Label& label, const Vec3d& q) const;
  /// Returns true if two points lie strictly outside the same plane of a label's domain. Then the segment between them
  /// does not meet the domain.
  [[nodiscard]] bool is_apart(const Label& label, const Vec3d& q, const Vec3d& r) const;
  /// Returns true if, for all points between q and r, the label is as close as its plane, line or point. This holds
  /// over a triangle, in the slab of an edge, and everywhere for a vertex.
  [[nodiscard]] bool is_attained(const Label& label, const Vec3d& q, const Vec3d& r) const;
  /// Returns true if a and b are adjacent triangles of the same face, and the segment from q to r lies over their
  /// union.
  [[nodiscard]] bool is_attained(const Label& a, const Label& b, const Vec3d& q, const Vec3d& r) const;
  /// Returns the sign of (distance from a) - (distance from b), where a and b stand for the labels' planes, lines or
  /// points.
  [[nodiscard]] int compare_distances(const Label& a, const Label& b, const Vec3d& q) const;
  /// Returns the sign of the difference of both squared distances' polar forms at q and r. Consider the point sum(w_k
  /// q_k) with weights w_k >= 0 of sum 1. There, the difference of squared distances is the sum of w_i w_j times the
  /// polar form at q_i and q_j. So label a is further than label b everywhere in a convex hull if the sign is 1 for all
  /// pairs of its corners.
  [[nodiscard]] int compare_polar(const Label& a, const Label& b, const Vec3d& q, const Vec3d& r) const;

  /// Returns the labels that are closest to a point: several on walls. The result is exact for points in the solid. The
  /// result has no meaning outside the solid, where other edges and vertices may be closest. Cost: O(labels). This is
  /// the slow reference for faster methods.
  [[nodiscard]] std::vector<Label> closest_labels(const Vec3d& q) const;
  /// Returns the closest labels among the given labels, which must include all labels that are closest.
  [[nodiscard]] std::vector<Label> closest_labels(std::span<const Label> among, const Vec3d& q) const;
  /// Returns true if the labels are a triangle and one of its edges, or an edge and one of its ends. Then their squared
  /// distances differ by a square, which is 0 only on the plane between their domains.
  [[nodiscard]] bool are_incident(const Label& a, const Label& b) const;

  [[nodiscard]] SignCounts counts() const;

 private:
  template <class Expression>
  [[nodiscard]] int sign_of(const Expression& expression) const;
  /// Calls visit(side) for each plane of a label's domain, with the side of the point: 1 inside, 0 on the plane, -1
  /// outside. Stops and returns false as soon as visit() returns false.
  template <class Visit>
  bool all_sides(const Label& label, const Vec3d& q, Visit visit) const;

  const MeshView mesh_;
  const SiteTable& table_;
  const PolyhedronSites& sites_;
  std::vector<Label> all_;
  IndexRows edges_;  ///< for each vertex
  mutable std::atomic<std::size_t> asked_{0};
  mutable std::atomic<std::size_t> exact_{0};
};

}  // namespace blum::voronoi
