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

/// Returns the vector of length 1 in the direction of `v`, which has any length but 0.
[[nodiscard]] Vec3d unit(const Vec3d& v);

/// Returns the unit vector along (b - a) x (c - a), accurate also for triangles that are nearly lines.
[[nodiscard]] Vec3d unit_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c);

/// Number of a label in SiteLabels::all(). Triangles come first and keep their own numbers.
using LabelIndex = std::uint32_t;

/// Stands for the outside of the solid, and for "no label".
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
  Vec3d normal;                  ///< of length 1, towards the domain
  double offset = 0;             ///< normal . q of its points q
  LabelIndex beyond = outside;   ///< the label whose domain lies on its other side, if one exists
  std::uint32_t edge = outside;  ///< the edge of the mesh that lies in it, if one does

  [[nodiscard]] double height(const Vec3d& q) const { return dot(normal, q) - offset; }
};

/// A plane in which two labels are equally close.
struct Bisector {
  LabelIndex other = outside;  ///< the second label
  Vec3d normal;                ///< of length 2 at most, to the side where the first label is closer
  double offset = 0;

  [[nodiscard]] double height(const Vec3d& q) const { return dot(normal, q) - offset; }
};

/// A label in double. Positions are relative to LabelGeometry::centre().
struct PlacedLabel {
  SiteKind kind = SiteKind::face;
  std::uint32_t site = 0;
  Vec3d point;      ///< a corner of a triangle, an end of an edge, or the vertex
  Vec3d direction;  ///< of length 1: from a triangle into the solid, or along an edge
  std::uint32_t first_plane = 0, last_plane = 0;

  /// Returns the squared distance from its plane, line or point.
  [[nodiscard]] double squared_distance(const Vec3d& q) const { return polar(q, q); }
  /// Returns the polar form of squared_distance().
  [[nodiscard]] double polar(const Vec3d& q, const Vec3d& r) const {
    if (kind == SiteKind::face) return height(q) * height(r);
    if (kind == SiteKind::edge) return dot(cross(q - point, direction), cross(r - point, direction));
    return dot(q - point, r - point);
  }
  /// Returns the signed distance from a triangle's plane, positive on the solid's side.
  [[nodiscard]] double height(const Vec3d& q) const { return dot(direction, q - point); }
  /// Returns the closest point of its plane, line or point.
  [[nodiscard]] Vec3d foot(const Vec3d& q) const {
    if (kind == SiteKind::face) return q - direction * height(q);
    if (kind == SiteKind::edge) return point + direction * dot(direction, q - point);
    return point;
  }
  /// Returns the projection of a vector to its plane or line, shifted to the origin.
  [[nodiscard]] Vec3d along(const Vec3d& way) const {
    if (kind == SiteKind::face) return way - direction * dot(direction, way);
    return kind == SiteKind::edge ? direction * dot(direction, way) : Vec3d{};
  }
  /// Returns the squared distance along the line q + s e_axis, as a function of s.
  [[nodiscard]] Quadratic along(const Vec3d& q, std::size_t axis) const;
};

class LabelGeometry;

/// Polar form of the difference of the squared distances from two labels' planes, lines or points, with a bound on its
/// rounding.
///
/// Relative to a corner of both labels, a squared distance is q . r less the product of the projections to the label's
/// plane or line. So the difference is that of these products. They are small over the corner, where this is much more
/// precise than subtracting both distances.
class PolarDifference {
 public:
  PolarDifference(const LabelGeometry& labels, LabelIndex first, LabelIndex second);

  /// Returns the polar form of the first label less that of the second.
  [[nodiscard]] double at(const Vec3d& q, const Vec3d& r) const;
  [[nodiscard]] double error(const Vec3d& q, const Vec3d& r) const;

 private:
  const LabelGeometry& labels_;
  const PlacedLabel& first_;
  const PlacedLabel& second_;
  std::optional<Vec3d> corner_;
};

/// All labels in double, and bounds on their rounding.
class LabelGeometry {
 public:
  /// @param mesh, table, sites  of one polyhedron, as for SiteLabels.
  LabelGeometry(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites, const SiteLabels& labels);

  /// Returns the box around the mesh.
  [[nodiscard]] const Box3& box() const { return box_; }
  /// Returns the centre of the box.
  [[nodiscard]] const Vec3d& centre() const { return centre_; }
  /// Returns the diagonal of the box.
  [[nodiscard]] double size() const { return size_; }
  /// Returns the largest error of distances and of heights over planes, anywhere in the box.
  [[nodiscard]] double rounding() const { return rounding_; }
  /// Returns the largest error of the difference of two squared distances.
  /// @param distance  an upper bound of both distances.
  [[nodiscard]] double rounding_of_squares(double distance) const { return rounding_ * (4 * distance + rounding_); }

  [[nodiscard]] std::size_t count() const { return labels_.size(); }
  [[nodiscard]] const PlacedLabel& operator[](LabelIndex label) const { return labels_[label]; }
  /// Returns the site of a label; `outside` for the outside.
  [[nodiscard]] std::uint32_t site_of(LabelIndex label) const {
    return label == outside ? outside : labels_[label].site;
  }
  /// Returns the site of an edge or vertex of the mesh; nullopt if it is not a site, or is a thin vertex.
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
  /// Returns the planes of a domain between which a point of the label attains the distance from its plane, line or
  /// point. These are all planes of a triangle, those through the ends of an edge, and none of a vertex.
  [[nodiscard]] std::span<const DomainPlane> ends(LabelIndex label) const {
    const SiteKind kind = labels_[label].kind;
    return planes(label).first(kind == SiteKind::face ? 3 : kind == SiteKind::edge ? 2 : 0);
  }
  /// Returns a plane that decides which of two labels is closer, at points in both domains. It exists for two
  /// triangles, two vertices, and two edges with a common end. Heights may be off by twice the rounding.
  [[nodiscard]] std::optional<Bisector> bisector(LabelIndex a, LabelIndex b) const;
  /// Returns the plane of two triangles for points behind the first one, where its distance is minus its height.
  /// Returns nullopt if a label is not a triangle.
  [[nodiscard]] std::optional<Bisector> bisector_behind(LabelIndex a, LabelIndex b) const;
  /// Returns the bisectors across the sides of a triangle; `other` is `outside` if the side is not a convex edge.
  [[nodiscard]] std::span<const Bisector, 3> bisectors(LabelIndex triangle) const {
    return std::span<const Bisector, 3>(bisectors_.data() + std::size_t{3} * triangle, 3);
  }
  /// Returns the corners of a label, relative to the centre: three, two or one.
  [[nodiscard]] std::span<const Vec3d> corners(LabelIndex label) const {
    const std::size_t count = labels_[label].kind == SiteKind::face ? 3 : labels_[label].kind == SiteKind::edge ? 2 : 1;
    return std::span(corners_[label]).first(count);
  }
  /// Returns the closest point of a triangle, edge or vertex.
  [[nodiscard]] Vec3d closest_point(LabelIndex label, const Vec3d& q) const;
  /// Returns true if two labels are the triangles on both sides of a reflex edge.
  [[nodiscard]] bool share_reflex_edge(LabelIndex a, LabelIndex b) const;
  /// Returns a vertex of the mesh that is a corner of both labels.
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
  /// Returns true if a label's site is an edge or vertex of a given site, or the other way round. Between such sites,
  /// the closest one changes only at planes of their domains.
  [[nodiscard]] bool are_incident(std::uint32_t site, LabelIndex label) const;
  /// Returns true if are_incident() holds for two sites.
  [[nodiscard]] bool are_neighbours(std::uint32_t site, std::uint32_t other) const;
  /// A vertex with a cone thinner than this many radians is thin: its region counts as part of walls.
  static constexpr double thin = 1e-3;
  [[nodiscard]] std::span<const LabelIndex> thin_vertices() const { return thin_vertices_; }
  /// Returns true if a label is a thin vertex; false for the outside.
  [[nodiscard]] bool is_thin(LabelIndex label) const {
    return std::binary_search(thin_vertices_.begin(), thin_vertices_.end(), label);
  }
  /// Thin vertices with cones below this many radians count as closest nowhere. They are dents by rounding in faces
  /// that are otherwise flat. No grid in double could meet their regions.
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
  std::vector<Vec3d> places_;                                ///< of the mesh's vertices, relative to the centre
  std::vector<LabelIndex> thin_vertices_, unseen_vertices_;  ///< rising
  std::vector<Bisector> bisectors_;                          ///< three for each triangle
  using ConvexPair = std::array<std::uint32_t, 3>;
  std::vector<ConvexPair> convex_pairs_;  ///< two faces that share a convex edge, and a bisector; sorted
  std::vector<LabelIndex> label_of_edge_, label_of_vertex_;  ///< `outside` if none exists, or an unseen one

  /// Pairs of sites of which one is an edge or vertex of the other, in both orders, sorted.
  std::vector<std::array<std::uint32_t, 2>> neighbours_;
};

/// Returns the labels that may be closest somewhere in the convex hull of some corners (Sud 2006, 5.4: governors of a
/// cell). A label is excluded if its domain lies outside of the hull. It is also excluded if the surface point closest
/// to `middle` is closer than it all over the hull. The corners decide this: the squared distance from a plane, line or
/// point, less that from a point, is concave.
///
/// @param among  contains all labels that are closest anywhere in the hull.
/// @param corners  relative to the centre of the labels, like `middle`, which lies between them.
/// Cost: O(labels x corners).
[[nodiscard]] std::vector<LabelIndex> governors(const LabelGeometry& labels, std::span<const LabelIndex> among,
                                                std::span<const Vec3d> corners, const Vec3d& middle);

/// Returns the closest point of some triangles, edges and vertices, each taken as a whole, regardless of domains.
/// @param among  not empty.
[[nodiscard]] Vec3d closest_surface_point(const LabelGeometry& labels, std::span<const LabelIndex> among,
                                          const Vec3d& q);

}  // namespace blum::voronoi
