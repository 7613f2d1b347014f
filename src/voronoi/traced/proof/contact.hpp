// Blum: points with the same closest sites, as solutions of equations. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/bvh.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "voronoi/traced/proof/implied_equations.hpp"
#include "voronoi/traced/proof/site_bounds.hpp"
#include "voronoi/traced/traced_sites.hpp"

namespace blum::voronoi {

/// A cylinder, or a ball if its axis has no length.
struct Tube {
  Vec3d centre;
  Vec3d along;        ///< unit vector along the axis
  double half = 0;    ///< half the length of the axis
  double radius = 0;  ///< of the cylinder; of the ball

  /// Returns the largest distance of a point from the centre.
  [[nodiscard]] double reach() const;
  /// Returns the largest change of a linear function from its value at the centre.
  [[nodiscard]] double change(const Vec3d& slope) const;
};

/// Sites that are closest to the points of a curve, or to one point. Sites with one footprint are one group, because
/// their domains are side by side, and their distances are together one function with a continuous gradient.
///
/// Points with these closest sites are the solutions of equations. Groups have the same
/// distance, and points lie in the planes between the domains of a group. In general position, a curve has two
/// equations, and a point three.
///
/// In symmetric solids, some equations follow from the others, exactly, and are left out (implied_equations()).
class Contact {
 public:
  using Index = TracedSites::Index;

  /// @param mesh     of the sites.
  /// @param members  ascending.
  /// @param wanted   number of equations in general position: 2 for a curve, 3 for a point. If there are more, implied
  ///                 ones are looked for.
  Contact(const SiteBounds& bounds, const MeshView& mesh, const std::vector<Index>& members, std::size_t wanted);

  [[nodiscard]] std::size_t equation_count() const;
  /// Returns the equations near x as functions that are 0 at the solutions.
  /// @param reach  bounds hold within this distance of x.
  [[nodiscard]] std::vector<LinearBound> equations(const Vec3d& x, double reach) const;
  /// Returns the number of curves that meet at a point with these closest sites in general position; 0 if it is
  /// unknown.
  /// @param at  the point.
  [[nodiscard]] std::size_t degree(const Vec3d& at) const;
  /// Returns false if the equations may be wrong. Then a group has more members than share a footprint, or sites of a
  /// mirror have the same distance near a point in another plane.
  [[nodiscard]] bool is_regular(const Vec3d& at) const;
  /// Returns true if a vertex of the mesh belongs to all members.
  [[nodiscard]] bool is_at_vertex(std::uint32_t vertex) const;

  /// Returns true if footprints of all points of a tube on the members' planes, lines and points belong to the
  /// members. They may pass to another member of the group.
  [[nodiscard]] bool are_inside_domains(const Tube& tube) const;
  /// Returns true if no other part of the border is closest to a point of a tube.
  /// @param border  the triangles of the mesh.
  [[nodiscard]] bool are_closest(const Tube& tube, const Bvh& border) const;

 private:
  struct GroupPlane {
    const DomainSide* side;
    Index i, k;  ///< sites on its two sides
  };
  struct Group {
    std::vector<Index> members;
    Index lead;                      ///< the smallest member: a vertex, otherwise an edge
    std::vector<GroupPlane> planes;  ///< between members: all
    std::vector<GroupPlane> basis;   ///< independent ones
  };

  void add_planes(Group& group) const;
  [[nodiscard]] std::size_t degree_in_mirror() const;
  [[nodiscard]] std::size_t degree_of_symmetric(const Vec3d& at) const;
  [[nodiscard]] LinearBound distance(const Group& group, const Vec3d& x, double reach) const;
  [[nodiscard]] bool is_between_members(const Group& group, Index i, const DomainSide& side, double height) const;
  [[nodiscard]] bool is_end_of_two(const Group& group, Index i, const DomainSide& side) const;
  [[nodiscard]] bool is_inside_domain(const Group& group, Index i, const Tube& tube) const;
  [[nodiscard]] bool is_part_of_member(std::uint32_t triangle) const;

  const SiteBounds& bounds_;
  const TracedSites& sites_;
  const MeshView& mesh_;
  std::vector<Index> members_;
  std::vector<Group> groups_;
  ImpliedEquations implied_;
};

}  // namespace blum::voronoi
