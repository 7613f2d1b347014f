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

/// Returns the edges of a SiteTable at each of its vertices, in rising order.
[[nodiscard]] inline IndexRows edges_of_vertices(const SiteTable& table) {
  return detail::rows_of(table.edge_count(), table.vertex_count(),
                         [&](std::size_t edge) -> const Segment& { return table.edges()[edge]; });
}

/// Returns the other ends of edges at a vertex.
[[nodiscard]] inline std::vector<Vec3d> far_ends(const MeshView& mesh, const SiteTable& table, std::uint32_t v,
                                                 std::span<const std::uint32_t> edges) {
  std::vector<Vec3d> out;
  for (const std::uint32_t edge : edges) {
    const auto& [a, b] = table.edges()[edge];
    out.push_back(mesh.vertices[a == v ? b : a]);
  }
  return out;
}

/// An object that a point can be closest to: a triangle (part of a face), a reflex edge of the SiteTable, or a reflex
/// vertex.
struct Label {
  SiteKind kind = SiteKind::face;
  std::uint32_t index = 0;  ///< of the triangle, edge or vertex

  [[nodiscard]] friend bool operator==(const Label&, const Label&) = default;
};

/// Number of signs computed, and number of those that doubles left open.
struct SignCounts {
  std::size_t all = 0;
  std::size_t exact = 0;
};

/// The labels of a polyhedron, and exact signs about them at points given in double.
///
/// A label's domain contains the points that project onto it. For a triangle, that is the prism over it, which three
/// planes across it through its sides bound. For an edge, it is the slab between the planes across it through its ends,
/// outside of the prisms of its two triangles. For a vertex v, it is the points q with (q - v) . (w - v) <= 0 for all
/// its edges v - w.
///
/// If a label is closest to a point, the point is in its domain. Signs are computed in double with bounds on all
/// rounding, and without rounding if these leave them open. Signs that neighbouring labels share come from one
/// expression, so that they agree.
class SiteLabels {
 public:
  /// @param mesh, table, sites  of one polyhedron; must outlive this.
  SiteLabels(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites);

  [[nodiscard]] const std::vector<Label>& all() const { return all_; }
  /// Returns the site of a label. Faces are numbered first, then reflex edges, then reflex vertices.
  [[nodiscard]] std::uint32_t site_of(const Label& label) const;
  [[nodiscard]] std::size_t site_count() const;

  /// Returns the side of a point relative to the plane across a triangle through its side k (from corner k to the
  /// next). It is 1 on the triangle's side.
  [[nodiscard]] int side_of_triangle(std::uint32_t triangle, std::size_t k, const Vec3d& q) const;
  /// Returns the side of a point relative to the plane across an edge through one of its ends. It is 1 on the edge's
  /// side.
  /// @param end  0 or 1
  [[nodiscard]] int side_of_end(std::uint32_t edge, std::size_t end, const Vec3d& q) const;
  /// Returns true if a point is in a label's domain, borders included.
  [[nodiscard]] bool is_in_domain(const Label& label, const Vec3d& q) const;
  /// Returns true if two points lie strictly outside of the same plane of a label's domain. Then so does the segment
  /// between them.
  [[nodiscard]] bool is_apart(const Label& label, const Vec3d& q, const Vec3d& r) const;
  /// Returns true if a surface point attains the distance from a label's plane, line or point all the way between two
  /// points. That is so over a triangle, in the slab of an edge, and anywhere for a vertex.
  [[nodiscard]] bool is_attained(const Label& label, const Vec3d& q, const Vec3d& r) const;
  /// Returns the same for two triangles of one face that share an edge: true if the way between the points lies over
  /// them.
  [[nodiscard]] bool is_attained(const Label& a, const Label& b, const Vec3d& q, const Vec3d& r) const;
  /// Returns the sign of the distance from one label's plane, line or point less that from another's.
  [[nodiscard]] int compare_distances(const Label& a, const Label& b, const Vec3d& q) const;
  /// Returns the same sign for the polar forms of both squared distances. Squared distances are quadratic. At a point
  /// with weights w_k of points q_k, their difference is the sum of w_i w_j times the polar form at q_i and q_j. So a
  /// label is further than another one all over a convex hull if this is 1 for all pairs of its corners.
  [[nodiscard]] int compare_polar(const Label& a, const Label& b, const Vec3d& q, const Vec3d& r) const;

  /// Returns the labels that a point is closest to, exactly: more than one on walls. Outside of the solid the result is
  /// of no use, because other edges and vertices are closest there. Cost: O(labels); this is the slow reference for
  /// faster methods.
  [[nodiscard]] std::vector<Label> closest_labels(const Vec3d& q) const;
  /// Returns the closest of some labels, which must include all that are closest.
  [[nodiscard]] std::vector<Label> closest_labels(std::span<const Label> among, const Vec3d& q) const;
  /// Returns true if one label is a triangle and the other one of its edges, or an edge and one of its ends. Then
  /// squared distances differ by a square, which is 0 on the plane that separates their domains.
  [[nodiscard]] bool are_incident(const Label& a, const Label& b) const;

  [[nodiscard]] SignCounts counts() const;

 private:
  template <class Expression>
  [[nodiscard]] int sign_of(const Expression& expression) const;
  /// Calls visit(side) for each plane of a label's domain, with the side that a point lies on, 1 inside. Stops when
  /// visit returns false, and then returns false.
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
