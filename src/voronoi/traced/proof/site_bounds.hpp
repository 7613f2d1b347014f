// Blum: distances of sites, with bounds on their errors. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "voronoi/traced/traced_sites.hpp"

namespace blum::voronoi {

/// A number with a bound on its error.
struct Bounded {
  double value = 0;
  double error = 0;
};

/// A linear function that is close to a smooth one near a point.
struct LinearBound {
  Bounded value;      ///< at the point
  Vec3d slope;        ///< at the point
  double turned = 0;  ///< bound on the error of the slope
  double bend = 0;    ///< Lipschitz constant of the gradient within the given reach; infinite if there is none

  /// Returns a bound on the difference of the gradient from the slope within a distance of the point.
  [[nodiscard]] double slope_error(double way) const { return turned + bend * way; }
  /// Returns a bound on the difference of the function from the linear one, within a distance of the point. The error
  /// at the point itself is not part of it.
  [[nodiscard]] double error_over(double way) const { return (turned + 0.5 * bend * way) * way; }
};

/// Distances of sites, and heights above the sides of their domains. The bounds hold for every polyhedron with the same
/// flat faces whose corners lie within corner_error() of the vertices of the sites. They also cover rounding.
class SiteBounds {
 public:
  using Index = TracedSites::Index;

  /// @param mesh  of the sites.
  SiteBounds(const TracedSites& sites, const MeshView& mesh);

  [[nodiscard]] const TracedSites& sites() const { return sites_; }
  /// Returns the largest distance of a corner from the plane of its face, with rounding, in mesh units.
  [[nodiscard]] double corner_error() const { return corner_error_; }
  /// Returns the largest distance of a site's vertex from that of the mesh, in mesh units.
  [[nodiscard]] double moved() const { return moved_; }
  /// Returns true if no corner was moved, and all faces are flat as given, exactly.
  [[nodiscard]] bool are_faces_exact() const { return are_faces_exact_; }
  /// Returns true if no corner was moved, and all faces are flat as given, but for rounding.
  [[nodiscard]] bool are_corners_exact() const { return moved_ == 0 && corner_error_ <= 4 * rounding_; }
  /// Returns a bound on the rounding error of a distance, in mesh units.
  [[nodiscard]] double rounding() const { return rounding_; }

  /// Returns the distance of a site's plane, line or point.
  /// @param reach  the bound on the bend holds within this distance of x.
  [[nodiscard]] LinearBound distance(Index i, const Vec3d& x, double reach) const;
  /// Returns the height of x above the side between the domains of two sites.
  /// @param side  sites().side_between(i, k).
  [[nodiscard]] LinearBound height(const DomainSide& side, Index i, Index k, const Vec3d& x) const;
  /// Returns a bound on the error of a site's direction, radians.
  [[nodiscard]] double direction_error(Index i) const { return direction_error_[i]; }

 private:
  void add_side_errors();

  const TracedSites& sites_;
  double corner_error_ = 0;
  double moved_ = 0;
  double rounding_ = 0;
  bool are_faces_exact_ = false;
  std::vector<double> direction_error_;  ///< of each site
  /// For each site, of the normals of its sides, without that of the site beyond.
  std::vector<double> side_error_;
};

}  // namespace blum::voronoi
