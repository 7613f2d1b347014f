// Blum: seams and walls near a point where several sites are closest. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "blum/core/vec3.hpp"
#include "voronoi/traced/traced_sites.hpp"

namespace blum::voronoi {

/// The regions around a direction, counterclockwise as seen against it: from its tip.
struct RegionRing {
  /// Wall between two successive regions of a ring.
  struct Germ {
    TracedSites::Index before = 0;  ///< region clockwise of the wall
    TracedSites::Index after = 0;   ///< region counterclockwise of the wall
    Vec3d direction;                ///< unit vector along the wall, at right angles to the direction of the ring
  };
  std::vector<Germ> germs;
};

/// Direction in which a seam leaves a point.
struct SeamRay {
  Vec3d direction;                        ///< unit vector
  std::vector<TracedSites::Index> sites;  ///< ascending: closest sites along the ray
  RegionRing ring;
};

/// The regions near a point. The distance of each site is a linear function there, and planes bound the domains of
/// sites with a common footprint. If domains of such sites overlap, second derivatives decide.
class LocalStar {
 public:
  /// @param found  the closest sites of `at`, ascending.
  LocalStar(const TracedSites& sites, const Vec3d& at, const std::vector<TracedSites::Index>& found);

  /// Returns the rays along which at least three regions meet.
  [[nodiscard]] std::vector<SeamRay> rays() const;
  /// Returns the regions around a direction from the point.
  [[nodiscard]] SeamRay ray(const Vec3d& direction) const;

 private:
  using Index = TracedSites::Index;
  /// A closest site with its gradient and the sides of its domain at the point.
  struct Member {
    Index site = 0;
    Vec3d gradient;
    std::size_t group = 0;  ///< members with a common footprint have the same group
    std::vector<const DomainSide*> sides;
    Vec3d across;  ///< of an edge: unit vector at right angles to the edge and the gradient
  };
  /// Returns the second derivative of a member's distance in a direction, times the radius.
  [[nodiscard]] double bend(const Member& member, const Vec3d& direction) const;

  [[nodiscard]] std::vector<const Member*> closest_in(const Vec3d& direction, double tolerance) const;
  /// A plane that bounds regions of sites with a common footprint.
  struct Plane {
    Vec3d normal;
    std::size_t group = 0;
  };
  [[nodiscard]] std::vector<Plane> planes_of_groups() const;
  /// Returns the closest of some sites beside a direction: on the side of `across`, which is at right angles to it.
  [[nodiscard]] Index site_beside(const std::vector<const Member*>& near, const Vec3d& direction,
                                  const Vec3d& across) const;
  /// Returns a more precise normal of the plane through gradients near a plane.
  [[nodiscard]] Vec3d widest_normal(const Vec3d& normal, const Vec3d& point) const;
  /// Returns the directions in which at least three gradients have the same, least rate.
  [[nodiscard]] std::vector<Vec3d> facet_normals() const;
  void add(const Vec3d& direction, std::vector<SeamRay>& rays) const;

  const TracedSites& sites_;
  const Vec3d at_;
  double angle_tolerance_ = 0;
  std::vector<Member> members_;
  std::vector<Vec3d> groups_;  ///< gradients
};

}  // namespace blum::voronoi
