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

/// The edges of a SiteTable at each of its vertices, in rising order.
[[nodiscard]] inline IndexRows edges_of_vertices(const SiteTable& table) {
  return detail::rows_of(table.edge_count(), table.vertex_count(),
                         [&](std::size_t edge) -> const Segment& { return table.edges()[edge]; });
}

/// Where edges at a vertex end.
[[nodiscard]] inline std::vector<Vec3d> far_ends(const MeshView& mesh, const SiteTable& table, std::uint32_t v,
                                                 std::span<const std::uint32_t> edges) {
  std::vector<Vec3d> out;
  for (const std::uint32_t edge : edges) {
    const auto& [a, b] = table.edges()[edge];
    out.push_back(mesh.vertices[a == v ? b : a]);
  }
  return out;
}

/// What a point can be closest to: a triangle (a part of a face), a reflex edge of the SiteTable, or a reflex vertex.
struct Label {
  SiteKind kind = SiteKind::face;
  std::uint32_t index = 0;  ///< of the triangle, edge or vertex

  [[nodiscard]] friend bool operator==(const Label&, const Label&) = default;
};

/// How often signs were asked for, and how often doubles did not tell them.
struct SignCounts {
  std::size_t all = 0;
  std::size_t exact = 0;
};

/// The labels of a polyhedron, and exact signs about them at points given in double. A label's domain holds the points
/// that project onto it:
///
/// - of a triangle, the prism over it: three planes across it through its sides;
/// - of an edge, the slab between the planes across it through its ends, outside of the prisms of its two triangles;
/// - of a vertex, the points with (q - v) . (w - v) <= 0 for all its edges v - w.
///
/// Where a label is closest, the point is in its domain. Signs are computed in double with bounds on all rounding, and
/// without rounding where these leave them open; those that labels next to each other have in common come from one
/// expression, so that they agree.
class SiteLabels {
 public:
  /// @param mesh, table, sites  must stay; those of one polyhedron.
  SiteLabels(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites);

  [[nodiscard]] const std::vector<Label>& all() const { return all_; }
  /// The site that a label is of: faces are numbered first, then reflex edges, then reflex vertices.
  [[nodiscard]] std::uint32_t site_of(const Label& label) const;
  [[nodiscard]] std::size_t site_count() const;

  /// On which side of the plane across a triangle through its side k (from corner k to the next) a point lies: 1 on the
  /// triangle's.
  [[nodiscard]] int side_of_triangle(std::uint32_t triangle, std::size_t k, const Vec3d& q) const;
  /// On which side of the plane across an edge through one of its ends a point lies: 1 on the edge's. @param end  0 or
  /// 1
  [[nodiscard]] int side_of_end(std::uint32_t edge, std::size_t end, const Vec3d& q) const;
  /// Whether a point is in a label's domain, borders included.
  [[nodiscard]] bool is_in_domain(const Label& label, const Vec3d& q) const;
  /// Whether two points lie strictly outside of one and the same plane of a label's domain: then so does all between
  /// them.
  [[nodiscard]] bool is_apart(const Label& label, const Vec3d& q, const Vec3d& r) const;
  /// Whether the distance from a label's plane, line or point is that of a point of the surface all the way between two
  /// points: over a triangle, in the slab of an edge, and for vertices anywhere.
  [[nodiscard]] bool is_attained(const Label& label, const Vec3d& q, const Vec3d& r) const;
  /// The same of two triangles of one face that share an edge: whether the way from one point to the other is over
  /// both.
  [[nodiscard]] bool is_attained(const Label& a, const Label& b, const Vec3d& q, const Vec3d& r) const;
  /// The sign of the distance from one label's plane, line or point less that from another's.
  [[nodiscard]] int compare_distances(const Label& a, const Label& b, const Vec3d& q) const;
  /// The same of the polar form of both squared distances. Squared distances are quadratic: at a point with weights
  /// w_k of points q_k their difference is the sum of w_i w_j times the polar form at q_i and q_j. So a label is
  /// further than another one all over a convex hull where this is 1 for all pairs of its corners.
  [[nodiscard]] int compare_polar(const Label& a, const Label& b, const Vec3d& q, const Vec3d& r) const;

  /// The labels that a point is closest to, exactly: more than one on walls. For any point, as far as labels go:
  /// outside of the solid, where other edges and vertices are closest, this is of no use. Cost: O(labels); the slow
  /// reference for what is faster.
  [[nodiscard]] std::vector<Label> closest_labels(const Vec3d& q) const;
  /// Those of some labels, among which all closest ones must be.
  [[nodiscard]] std::vector<Label> closest_labels(std::span<const Label> among, const Vec3d& q) const;
  /// Whether one label is a triangle and the other one of its edges, or an edge and one of its ends: then squared
  /// distances differ by a square, which is 0 on the plane that parts their domains.
  [[nodiscard]] bool are_incident(const Label& a, const Label& b) const;

  [[nodiscard]] SignCounts counts() const;

 private:
  template <class Expression>
  [[nodiscard]] int sign_of(const Expression& expression) const;
  /// Calls visit(side of a plane of a label's domain that a point lies on, 1 inside) until it returns false; whether
  /// none did.
  template <class Visit>
  bool all_sides(const Label& label, const Vec3d& q, Visit visit) const;

  const MeshView mesh_;
  const SiteTable& table_;
  const PolyhedronSites& sites_;
  std::vector<Label> all_;
  IndexRows edges_;  ///< of each vertex
  mutable std::atomic<std::size_t> asked_{0};
  mutable std::atomic<std::size_t> exact_{0};
};

}  // namespace blum::voronoi
