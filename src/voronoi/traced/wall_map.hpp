// Blum: plane coordinates of the walls between two sites. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include "blum/core/vec3.hpp"
#include "voronoi/traced/traced_sites.hpp"

namespace blum::voronoi {

/// One-to-one map between a wall and a part of the plane.
///
/// A planar wall is its own map. Otherwise, a ball that touches the first site is given by the touching point and the
/// direction of its centre. For a face, two coordinates of the point determine both; for an edge, the place along it
/// and the angle around it. The radius follows from the second site. (docs/theory/voronoi.md, "Traced structure".)
class WallMap {
 public:
  using Point = std::array<double, 2>;

  /// @param plane   normal of the wall, if it is planar.
  /// @param sample  points of the wall.
  WallMap(const TracedSites& sites, TracedSites::Index first, TracedSites::Index second, std::optional<Vec3d> normal,
          std::span<const Vec3d> sample);

  [[nodiscard]] Point to_plane(const Vec3d& x) const;
  [[nodiscard]] Vec3d from_plane(const Point& p) const;
  /// Returns the distance of a point of the wall from its sites.
  [[nodiscard]] double radius(const Vec3d& x) const { return sites_.distance(from_, x); }

 private:
  const TracedSites& sites_;
  TracedSites::Index from_ = 0;  ///< site whose touching points are the coordinates
  TracedSites::Index to_ = 0;
  bool is_planar_ = false;
  Vec3d origin_;
  std::array<Vec3d, 2> axes_;
  double scale_ = 1;  ///< length of a radian
};

/// Returns the radius of the ball that touches a site's plane, line or point, and has its centre at p + radius * w.
[[nodiscard]] double touching_radius(const TracedSite& site, const Vec3d& p, const Vec3d& w);

}  // namespace blum::voronoi
