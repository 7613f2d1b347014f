// Blum: labels of a polyhedron in double, with bounds on rounding. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"
#include "voronoi/site_labels.hpp"

namespace blum::voronoi {

/// Returns the unit vector in the direction of `v`, which may have any length except 0.
[[nodiscard]] Vec3d unit(const Vec3d& v);

/// Returns two unit vectors at right angles to a unit vector n and to each other. The first one, the second one and n
/// are a right-handed system.
[[nodiscard]] std::array<Vec3d, 2> axes_across(const Vec3d& n);

/// Returns the unit vector along (b - a) x (c - a). It is accurate even if the three points are nearly collinear.
[[nodiscard]] Vec3d unit_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c);

/// Returns the angle between two vectors in degrees.
[[nodiscard]] double degrees_between(const Vec3d& a, const Vec3d& b);

/// Index of a label in SiteLabels::all(). Triangles come first, so their labels have the indices of the triangles.
using LabelIndex = std::uint32_t;

/// Represents the outside of the solid, and "no label".
constexpr LabelIndex outside = std::numeric_limits<LabelIndex>::max();

/// A quadratic function a s^2 + b s + c of one variable.
struct Quadratic {
  double a = 0, b = 0, c = 0;

  [[nodiscard]] double at(double s) const { return (a * s + b) * s + c; }
  [[nodiscard]] friend Quadratic operator-(const Quadratic& p, const Quadratic& q) {
    return {p.a - q.a, p.b - q.b, p.c - q.c};
  }
};

/// A plane that bounds a label's domain.
struct DomainPlane {
  Vec3d normal;                  ///< unit vector towards the domain
  double offset = 0;             ///< normal . q, for points q of the plane
  LabelIndex beyond = outside;   ///< the label with the domain on the plane's other side, if any
  std::uint32_t edge = outside;  ///< the edge of the mesh that lies in the plane, if any

  [[nodiscard]] double height(const Vec3d& q) const { return dot(normal, q) - offset; }
};

/// A plane whose points are equally far from two labels.
struct Bisector {
  LabelIndex other = outside;  ///< the second label
  Vec3d normal;                ///< points to the side where the first label is closer; length at most 2
  double offset = 0;

  [[nodiscard]] double height(const Vec3d& q) const { return dot(normal, q) - offset; }
};

/// A label with coordinates in double, relative to LabelGeometry::centre().
struct PlacedLabel {
  SiteKind kind = SiteKind::face;
  std::uint32_t site = 0;
  Vec3d point;      ///< a corner of a triangle, an end of an edge, or the vertex
  Vec3d direction;  ///< unit vector: from a triangle into the solid, or along an edge
  std::uint32_t first_plane = 0, last_plane = 0;

  /// Returns the squared distance of q from the label's plane, line or point.
  [[nodiscard]] double squared_distance(const Vec3d& q) const { return polar(q, q); }
  /// Returns the polar form of squared_distance().
  [[nodiscard]] double polar(const Vec3d& q, const Vec3d& r) const {
    if (kind == SiteKind::face) return height(q) * height(r);
    if (kind == SiteKind::edge) return dot(cross(q - point, direction), cross(r - point, direction));
    return dot(q - point, r - point);
  }
  /// Returns the signed distance of q from a triangle's plane; positive on the solid's side.
  [[nodiscard]] double height(const Vec3d& q) const { return dot(direction, q - point); }
  /// Returns the foot of q: the closest point of the label's plane, line or point.
  [[nodiscard]] Vec3d foot(const Vec3d& q) const {
    if (kind == SiteKind::face) return q - direction * height(q);
    if (kind == SiteKind::edge) return point + direction * dot(direction, q - point);
    return point;
  }
  /// Returns the projection of a vector to the label's plane or line through the origin.
  [[nodiscard]] Vec3d along(const Vec3d& way) const {
    if (kind == SiteKind::face) return way - direction * dot(direction, way);
    return kind == SiteKind::edge ? direction * dot(direction, way) : Vec3d{};
  }
  /// Returns the squared distance of q + s * e_axis from the label's plane, line or point, as a function of s.
  [[nodiscard]] Quadratic along(const Vec3d& q, std::size_t axis) const;
};

class LabelGeometry;

/// The polar form of the difference of two squared distances, with a bound on its rounding error. The distances are
/// those from two labels' planes, lines or points.
///
/// Let q and r be relative to a common corner of both labels. Then the polar form of a squared distance is q . r minus
/// the dot product of both projections to the label's plane or line. The terms q . r cancel, so the difference is that
/// of these products. Near the perpendicular over the corner the products are small, and this is much more precise than
/// subtracting both distances.
class PolarDifference {
 public:
  PolarDifference(const LabelGeometry& labels, LabelIndex first, LabelIndex second);

  /// Returns the polar form of the first label minus that of the second.
  [[nodiscard]] double at(const Vec3d& q, const Vec3d& r) const;
  [[nodiscard]] double error(const Vec3d& q, const Vec3d& r) const;

 private:
  const LabelGeometry& labels_;
  const PlacedLabel& first_;
  const PlacedLabel& second_;
  std::optional<Vec3d> corner_;
};

/// All labels with coordinates in double, and bounds on rounding errors.
class LabelGeometry {
 public:
  /// @param mesh, table, sites  all of the same polyhedron, as for SiteLabels.
  LabelGeometry(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites, const SiteLabels& labels);

  /// Returns the box around the mesh.
  [[nodiscard]] const Box3& box() const { return box_; }
  /// Returns the centre of the box.
  [[nodiscard]] const Vec3d& centre() const { return centre_; }
  /// Returns the diagonal of the box.
  [[nodiscard]] double size() const { return size_; }
  /// Returns a bound on the errors of distances and of heights over planes, for all points in the box.
  [[nodiscard]] double rounding() const { return rounding_; }
  /// Returns a bound on the error of the difference of two squared distances.
  /// @param distance  an upper bound of both distances.
  [[nodiscard]] double rounding_of_squares(double distance) const { return rounding_ * (4 * distance + rounding_); }

  [[nodiscard]] std::size_t count() const { return labels_.size(); }
  [[nodiscard]] const PlacedLabel& operator[](LabelIndex label) const { return labels_[label]; }
  /// Returns the site of a label; `outside` for the outside.
  [[nodiscard]] std::uint32_t site_of(LabelIndex label) const {
    return label == outside ? outside : labels_[label].site;
  }
  /// Returns the site of an edge or vertex of the mesh. Returns nullopt if it is not a site, or if it is a thin vertex.
  [[nodiscard]] std::optional<std::uint32_t> site_of_edge(std::uint32_t edge) const {
    return site_if_any(label_of_edge_[edge]);
  }
  [[nodiscard]] std::optional<std::uint32_t> site_of_vertex(std::uint32_t v) const {
    return is_thin(label_of_vertex_[v]) ? std::nullopt : site_if_any(label_of_vertex_[v]);
  }
  [[nodiscard]] std::span<const DomainPlane> planes(LabelIndex label) const {
    return std::span(planes_).subspan(labels_[label].first_plane,
                                      labels_[label].last_plane - labels_[label].first_plane);
  }
  /// Returns those planes of a domain that decide if the label contains the foot of a point. Between these planes, the
  /// label is as close as its plane, line or point. The planes are all planes of a triangle, the two planes through the
  /// ends of an edge, and none for a vertex.
  [[nodiscard]] std::span<const DomainPlane> ends(LabelIndex label) const {
    const SiteKind kind = labels_[label].kind;
    return planes(label).first(kind == SiteKind::face ? 3 : kind == SiteKind::edge ? 2 : 0);
  }
  /// Returns a plane that decides which of two labels is closer to points in both domains. The plane exists for two
  /// triangles, two vertices, and two edges with a common end. Heights over it have errors of up to 2 rounding().
  [[nodiscard]] std::optional<Bisector> bisector(LabelIndex a, LabelIndex b) const;
  /// Returns the bisector of two triangles for points behind the first triangle, where its distance is minus the
  /// height. Returns nullopt if a label is not a triangle.
  [[nodiscard]] std::optional<Bisector> bisector_behind(LabelIndex a, LabelIndex b) const;
  /// Returns the bisectors of a triangle and its neighbours across its three sides. Where the side is not a convex
  /// edge, `other` is `outside`.
  [[nodiscard]] std::span<const Bisector, 3> bisectors(LabelIndex triangle) const {
    return std::span<const Bisector, 3>(bisectors_.data() + std::size_t{3} * triangle, 3);
  }
  /// Returns the three, two or one corners of a label, relative to the centre.
  [[nodiscard]] std::span<const Vec3d> corners(LabelIndex label) const {
    const std::size_t count = labels_[label].kind == SiteKind::face ? 3 : labels_[label].kind == SiteKind::edge ? 2 : 1;
    return std::span(corners_[label]).first(count);
  }
  /// Returns the point of a triangle, edge or vertex closest to q.
  [[nodiscard]] Vec3d closest_point(LabelIndex label, const Vec3d& q) const;
  /// Returns true if two labels are the two triangles at a reflex edge.
  [[nodiscard]] bool share_reflex_edge(LabelIndex a, LabelIndex b) const;
  /// Returns a vertex of the mesh that is a corner of both labels; nullopt if none is.
  [[nodiscard]] std::optional<std::uint32_t> common_vertex(LabelIndex a, LabelIndex b) const;
  [[nodiscard]] bool has_corner(LabelIndex label, const Vec3d& corner) const;
  /// Returns the vertices of the mesh that are a label's corners, in the order of corners().
  [[nodiscard]] std::span<const std::uint32_t> vertices(LabelIndex label) const {
    return std::span(vertices_[label]).first(corners(label).size());
  }
  [[nodiscard]] bool has_vertex(LabelIndex label, std::uint32_t v) const {
    const std::span<const std::uint32_t> own = vertices(label);
    return std::find(own.begin(), own.end(), v) != own.end();
  }
  /// Returns the position of a vertex of the mesh, relative to the centre.
  [[nodiscard]] Vec3d place(std::uint32_t v) const { return places_[v]; }
  /// Returns true if a label's site is an edge or vertex of a given site, or vice versa. Between two such sites, the
  /// closer one changes only at planes of their domains.
  [[nodiscard]] bool are_incident(std::uint32_t site, LabelIndex label) const;
  /// Returns true if one of two sites is an edge or vertex of the other site.
  [[nodiscard]] bool are_neighbours(std::uint32_t site, std::uint32_t other) const;
  /// A vertex is thin if its dual cone is narrower than this many radians. Its region counts as a part of walls.
  static constexpr double thin = 1e-3;
  [[nodiscard]] std::span<const LabelIndex> thin_vertices() const { return thin_vertices_; }
  /// Returns true if a label is a thin vertex; false for the outside.
  [[nodiscard]] bool is_thin(LabelIndex label) const {
    return std::binary_search(thin_vertices_.begin(), thin_vertices_.end(), label);
  }
  /// A thin vertex is unseen if its dual cone is narrower than this many radians. An unseen vertex is treated as
  /// closest nowhere. Unseen vertices are dents that rounding makes in flat faces. No grid with double coordinates
  /// could meet their regions.
  static constexpr double unseen = 1e-12;
  [[nodiscard]] bool is_unseen(LabelIndex label) const {
    return std::binary_search(unseen_vertices_.begin(), unseen_vertices_.end(), label);
  }

 private:
  [[nodiscard]] std::optional<std::uint32_t> site_if_any(LabelIndex label) const {
    return label == outside ? std::nullopt : std::optional(labels_[label].site);
  }
  void add_triangles(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites);
  void add_edges(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites);
  void add_vertices(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites, const IndexRows& edges);
  void add_bisectors(const PolyhedronSites& sites);
  void add_neighbours(const SiteTable& table, const PolyhedronSites& sites);

  Box3 box_;
  Vec3d centre_;
  double size_ = 0;
  double rounding_ = 0;
  std::vector<PlacedLabel> labels_;
  std::vector<DomainPlane> planes_;
  std::vector<std::array<Vec3d, 3>> corners_;
  std::vector<std::array<std::uint32_t, 3>> vertices_;
  std::vector<Vec3d> places_;                                ///< vertices of the mesh, relative to the centre
  std::vector<LabelIndex> thin_vertices_, unseen_vertices_;  ///< in ascending order
  std::vector<Bisector> bisectors_;                          ///< three for each triangle, see bisectors()
  using ConvexPair = std::array<std::uint32_t, 3>;
  std::vector<ConvexPair> convex_pairs_;  ///< (site, site of a face across a convex edge, index in bisectors_); sorted
  std::vector<LabelIndex> label_of_edge_, label_of_vertex_;  ///< `outside` without a label, or for an unseen vertex

  /// Pairs of sites of which one is an edge or vertex of the other. Each pair is listed in both orders; all are sorted.
  std::vector<std::array<std::uint32_t, 2>> neighbours_;
};

/// Returns the labels that may be closest to a point in the convex hull of `corners` (Sud 2006, 5.4: governors of a
/// cell). A label is excluded if its domain does not meet the hull. It is also excluded if one surface point, the point
/// closest to `middle`, is closer than the label everywhere in the hull. A test at the corners suffices, because the
/// squared distance from a plane, line or point minus that from the surface point is concave.
///
/// @param among  includes all labels that are closest to a point in the hull.
/// @param corners  relative to the centre of the labels, as is `middle`, which lies between the corners.
/// Cost: O(labels x corners).
[[nodiscard]] std::vector<LabelIndex> governors(const LabelGeometry& labels, std::span<const LabelIndex> among,
                                                std::span<const Vec3d> corners, const Vec3d& middle);

/// Returns the point closest to q on the given triangles, edges and vertices, without regard to domains.
/// @param among  not empty.
[[nodiscard]] Vec3d closest_surface_point(const LabelGeometry& labels, std::span<const LabelIndex> among,
                                          const Vec3d& q);

}  // namespace blum::voronoi
