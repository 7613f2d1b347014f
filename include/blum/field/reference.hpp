// Blum: brute-force fields in double precision, for tests and comparison. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/ids.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::reference {

/// Returns the distance from a point to the closed triangle abc, which may be degenerate to a segment or a point.
[[nodiscard]] double triangle_distance(const Vec3d& query, const Vec3d& a, const Vec3d& b, const Vec3d& c);

/// Returns the distance from a point to the closed segment ab, which may be degenerate to a point.
[[nodiscard]] double segment_distance(const Vec3d& query, const Vec3d& a, const Vec3d& b);

struct Nearest {
  double distance = 0;
  SiteId site;  ///< closest site; the smallest id if several sites are equally close
};

/// Searches all sites for each query, in double precision: slow and simple. The mesh must outlive this object.
class BruteForce {
 public:
  explicit BruteForce(const MeshView& mesh);

  [[nodiscard]] const SiteTable& sites() const { return sites_; }
  /// Returns the distance from a point to the closure of one site.
  [[nodiscard]] double site_distance(SiteId id, const Vec3d& query) const;
  /// Returns the closest of all sites. Vertices that no triangle, segment or point uses are not sites here. Cost:
  /// O(sites).
  [[nodiscard]] Nearest nearest(const Vec3d& query) const;
  /// Returns the closest of the sites that share no label with the first site (see share_label()). Fields of order 2
  /// use this rule.
  /// @param first   the closest site of the query.
  /// @param labels  one label per vertex of the mesh. If the list is empty, each vertex has a different label.
  /// Cost: O(sites).
  [[nodiscard]] std::optional<Nearest> second(const Vec3d& query, SiteId first,
                                              std::span<const std::uint32_t> labels = {}) const;
  /// Returns true if a vertex of site a and a vertex of site b have the same label.
  [[nodiscard]] bool share_label(SiteId a, SiteId b, std::span<const std::uint32_t> labels = {}) const;

 private:
  MeshView mesh_;
  SiteTable sites_;
  std::vector<bool> named_;
};

/// Returns the generalized winding number of the triangles around a point: the sum of all signed solid angles over 4 pi
/// (van Oosterom, Strackee 1983). It is 1 inside a closed, outward-oriented surface and 0 outside. Cost: O(triangles).
[[nodiscard]] double winding_number(const MeshView& mesh, const Vec3d& query);

}  // namespace blum::reference
