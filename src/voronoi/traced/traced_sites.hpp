// Blum: sites of a polyhedron for the tracing of seams. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/box_bvh.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"

namespace blum::voronoi {

/// A plane that bounds the domain of a site: the points whose closest point of the site's plane, line or point belongs
/// to the site.
struct DomainSide {
  Vec3d normal;                  ///< unit vector towards the domain; for a face, in its plane
  std::array<Vec3d, 2> ends;     ///< for a face: the ends of the side; otherwise, both are a point of the plane
  bool is_open = true;           ///< false at convex edges, which no closest point inside the solid passes
  std::array<double, 2> from{};  ///< for a face: ends[0] in the coordinates of its plane
  std::array<double, 2> to{};    ///< for a face: ends[1] in the coordinates of its plane

  [[nodiscard]] double height(const Vec3d& q) const { return dot(normal, q - ends[0]); }
};

/// Finds the sides of a face that are near a point of its plane, if it has many.
struct SideIndex {
  BoxBvh boxes;                      ///< around the sides, in the coordinates of the plane
  double low = 0;                    ///< of all sides, along the second axis
  double per_unit = 0;               ///< bands per mesh unit along the second axis
  std::vector<std::uint32_t> first;  ///< of each band, in `sides`; one more than there are bands
  std::vector<std::uint32_t> sides;  ///< that cross each band
};

/// Face, reflex edge or reflex vertex.
struct TracedSite {
  SiteKind kind = SiteKind::face;
  std::int32_t number = 0;                ///< as in voronoi_sites()
  Vec3d point;                            ///< of the plane; the first end of an edge; the vertex
  Vec3d direction;                        ///< unit vector: of a face, into the solid; along an edge
  std::array<Vec3d, 2> axes;              ///< of a face: coordinates in its plane. Otherwise unused
  double length = 0;                      ///< of an edge
  std::vector<DomainSide> sides;          ///< of a face: its whole boundary
  std::vector<std::uint32_t> vertices;    ///< vertices of the mesh that the site contains, ascending
  std::uint32_t border = 0;               ///< of an edge: its number in TracedSites::edges()
  std::uint32_t triangle_or_element = 0;  ///< a triangle of the face; the edge or vertex of the SiteTable
  Box3 box;
  bool is_convex = false;          ///< of a face: the sides bound a convex polygon
  std::optional<SideIndex> index;  ///< of a face with many sides
};

/// A convex edge, at which the sheet between its two faces ends. Or a reflex edge, at which two walls end.
struct BorderEdge {
  std::array<std::uint32_t, 2> vertices;
  std::array<std::uint32_t, 2> faces;  ///< sites
  std::uint32_t own = 0xffffffff;      ///< site of a reflex edge
  [[nodiscard]] bool is_reflex() const { return own != 0xffffffff; }
};

/// Treatment of junctions and seams that are nearly at the same position.
enum class TracedPlaces : std::uint8_t {
  merged,   ///< Junctions and seams closer than the tolerance are one. Symmetric solids have such ones.
  separate  ///< Only rounding of numbers is treated as 0. Vertices move so that joined faces are flat.
};

/// Differences that are treated as 0.
struct TracePrecision {
  double distance = 0;   ///< mesh units
  double apart = 0;      ///< of two junctions, mesh units
  double angle = 0;      ///< between gradients, radians
  double direction = 0;  ///< between seams that leave a junction: difference of unit vectors
};

/// The sites of a polyhedron, and the functions of their distances. Coordinates are relative to origin().
class TracedSites {
 public:
  using Index = std::uint32_t;

  /// Returns nothing if joined triangles cannot be made flat, or make other vertices reflex.
  /// @param flatness  triangles whose corners lie within twice this distance of one plane are one face, mesh units.
  static std::optional<TracedSites> of(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites,
                                       double flatness, TracedPlaces places);

  [[nodiscard]] const std::vector<TracedSite>& all() const { return sites_; }
  [[nodiscard]] const TracedSite& operator[](Index i) const { return sites_[i]; }
  [[nodiscard]] std::size_t size() const { return sites_.size(); }
  [[nodiscard]] const std::vector<BorderEdge>& edges() const { return edges_; }
  [[nodiscard]] const std::vector<Vec3d>& vertices() const { return vertices_; }
  [[nodiscard]] std::size_t count(SiteKind kind) const;
  [[nodiscard]] std::size_t face_count() const { return count(SiteKind::face); }
  /// Returns reflex vertices that are not sites, since the cone of their region is thinner than rounding.
  [[nodiscard]] const std::vector<std::uint32_t>& left_out() const { return left_out_; }
  /// Returns the number of holes in all faces together.
  [[nodiscard]] std::size_t hole_count() const;
  /// Returns the face of each triangle of the mesh.
  [[nodiscard]] const std::vector<Index>& faces() const { return face_of_; }
  /// Returns the face of a triangle of the mesh.
  [[nodiscard]] Index face_of(std::uint32_t triangle) const { return face_of_[triangle]; }
  /// Returns the middle of the box around the solid, in the coordinates of the mesh.
  [[nodiscard]] const Vec3d& origin() const { return origin_; }
  /// Returns the diagonal of the box around the solid.
  [[nodiscard]] double extent() const { return extent_; }
  /// Distances below this value, in mesh units, are treated as 0.
  [[nodiscard]] double tolerance() const { return precision_.distance; }
  [[nodiscard]] const TracePrecision& precision() const { return precision_; }

  /// Returns the distance within which the place is unknown where a curve touches a region: there, distances differ by
  /// the square of the way.
  [[nodiscard]] double blur(double radius) const { return 4 * std::sqrt(precision_.distance * radius); }

  /// Returns the distance of x from the plane, line or point of a site. It is negative behind a face.
  [[nodiscard]] double distance(Index i, const Vec3d& x) const;
  /// Returns the closest point of the plane, line or point of a site.
  [[nodiscard]] Vec3d foot(Index i, const Vec3d& x) const;
  /// Returns the gradient of distance(), a unit vector.
  [[nodiscard]] Vec3d gradient(Index i, const Vec3d& x) const;
  /// Returns how far x lies outside of the domain of a site at least; 0 inside. If this is more than `most`, the result
  /// may be any value above `most`.
  [[nodiscard]] double outside(Index i, const Vec3d& x, double most = std::numeric_limits<double>::infinity()) const;
  /// The side of a face beyond which a point lies.
  struct OutsideSide {
    const DomainSide* side = nullptr;
    double others = 0;  ///< distance from the other sides of the face, within its plane
  };
  /// Returns the closest side of a face.
  /// @param x  its projection lies outside of the face.
  [[nodiscard]] OutsideSide outside_side(Index i, const Vec3d& x) const;
  /// Returns the distance of x from the site itself, or a lower bound on it.
  /// @param beyond  outside(i, x)
  [[nodiscard]] double least_distance(Index i, const Vec3d& x, double beyond) const;
  /// Returns the sides of a site's domain that contain x, within a tolerance.
  [[nodiscard]] std::vector<const DomainSide*> sides_at(Index i, const Vec3d& x, double tolerance) const;
  /// Calls visit(side) for all sides of a site's domain. A face with many sides may leave out those at a larger
  /// distance than `reach` from the foot of x. Their order is then not that of the sides.
  template <class Visit>
  void for_each_side(Index i, const Vec3d& x, double reach, const Visit& visit) const {
    const TracedSite& site = sites_[i];
    if (!site.index) {
      for (const DomainSide& side : site.sides) visit(side);
      return;
    }
    const Vec3d step = x - site.point;
    const double limit = (1 + 1e-9) * reach + 1e-13 * extent_;
    site.index->boxes.for_each_near({dot(site.axes[0], step), dot(site.axes[1], step), 0}, limit, [&](Index k) {
      visit(site.sides[k]);
      return limit;
    });
  }
  /// Returns true if the direction h from x leads into the domain of a site, or along its border.
  [[nodiscard]] bool leads_inside(Index i, const std::vector<const DomainSide*>& sides, const Vec3d& h,
                                  double tolerance) const;

  /// Returns the side of a domain between a face and its edge, between an edge and its end, or between two edges on one
  /// line. It points towards the domain of the smaller site, or of `second`. Returns null for all other pairs of sites.
  [[nodiscard]] const DomainSide* side_between(Index first, Index second) const;

  /// Plane between the regions of two edges with a common vertex, in which both domains overlap.
  struct EdgePlane {
    Vec3d normal;  ///< unit vector into the region of the first edge
    Vec3d point;
    [[nodiscard]] double height(const Vec3d& x) const { return dot(normal, x - point); }
  };
  /// Returns nothing for all other pairs of sites. The plane shows which edge is closer where distances differ by less
  /// than rounding. Near it, they differ by the height times the way along the edge, divided by the radius.
  [[nodiscard]] std::optional<EdgePlane> plane_between_edges(Index first, Index second) const;

  /// The closest sites of a point.
  struct Closest {
    double radius = std::numeric_limits<double>::infinity();
    /// Ascending: all within the tolerance of the radius. If planes between edges show that one is closer, without the
    /// others.
    std::vector<Index> sites;
    std::size_t examined = 0;  ///< sites whose distance was computed
  };
  /// @param guess  of the radius. The search is fast if the radius is at most this value, and not much smaller.
  [[nodiscard]] Closest closest(const Vec3d& x, double tolerance,
                                double guess = std::numeric_limits<double>::infinity()) const;
  /// Returns the closest vertex of the mesh within a distance of x.
  [[nodiscard]] std::optional<std::uint32_t> vertex_near(const Vec3d& x, double distance) const;
  /// Calls visit(site) for each site whose box is within a distance of x.
  template <class Visit>
  void for_each_within(const Vec3d& x, double distance, const Visit& visit) const {
    boxes_->for_each_near(x, distance, [&](Index i) {
      visit(i);
      return distance;
    });
  }

 private:
  friend class SiteFinder;
  [[nodiscard]] Closest closest_within(const Vec3d& x, double tolerance, double limit) const;
  void remove_further_edges(const Vec3d& x, double tolerance, std::vector<Index>& sites) const;
  [[nodiscard]] double outside_polygon(const TracedSite& face, const Vec3d& x, double most) const;

  std::vector<TracedSite> sites_;
  std::vector<BorderEdge> edges_;
  std::vector<Vec3d> vertices_;
  std::vector<Index> face_of_;
  std::vector<std::uint32_t> left_out_;
  std::optional<BoxBvh> boxes_;
  std::optional<BoxBvh> vertex_boxes_;  ///< a point for each vertex
  Vec3d origin_;
  double extent_ = 0;
  TracePrecision precision_;
};

}  // namespace blum::voronoi
