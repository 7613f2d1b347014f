// Blum: exact distances from the sites of a polyhedron. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"

namespace blum::voronoi {

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
  /// The sign of the distance from one label's plane, line or point less that from another's.
  [[nodiscard]] int compare_distances(const Label& a, const Label& b, const Vec3d& q) const;

  /// The labels that a point is closest to, exactly: more than one on walls. For any point, as far as labels go:
  /// outside of the solid, where other edges and vertices are closest, this is of no use. Cost: O(labels); the slow
  /// reference for what is faster.
  [[nodiscard]] std::vector<Label> closest_labels(const Vec3d& q) const;

  [[nodiscard]] SignCounts counts() const;

 private:
  template <class Expression>
  [[nodiscard]] int sign_of(const Expression& expression) const;
  [[nodiscard]] bool is_in_edge_domain(std::uint32_t edge, const Vec3d& q) const;

  const MeshView mesh_;
  const SiteTable& table_;
  const PolyhedronSites& sites_;
  std::vector<Label> all_;
  /// Edges of reflex vertex k: edges_[first_[k] .. first_[k + 1]).
  std::vector<std::uint32_t> first_, edges_;
  mutable std::atomic<std::size_t> asked_{0};
  mutable std::atomic<std::size_t> exact_{0};
};

}  // namespace blum::voronoi
