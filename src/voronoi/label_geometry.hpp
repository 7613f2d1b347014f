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

/// A vector of length 1 in the direction of one that is not 0, of any length.
[[nodiscard]] Vec3d unit(const Vec3d& v);

/// The direction of (b - a) x (c - a), also of triangles that are nearly lines.
[[nodiscard]] Vec3d unit_normal(const Vec3d& a, const Vec3d& b, const Vec3d& c);

/// The number of a label in SiteLabels::all(); triangles come first, with their own numbers.
using LabelIndex = std::uint32_t;

/// Stands for what is outside of the solid, and for "no label".
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
  double offset = 0;             ///< normal . q of its points
  LabelIndex beyond = outside;   ///< the label whose domain lies on its other side, where there is one
  std::uint32_t edge = outside;  ///< the edge of the mesh that it runs through along its length, where there is one

  [[nodiscard]] double height(const Vec3d& q) const { return dot(normal, q) - offset; }
};

/// A plane in which two labels are equally close.
struct Bisector {
  LabelIndex other = outside;  ///< the second label
  Vec3d normal;                ///< of length 2 at most, to the side where the first label is closer
  double offset = 0;

  [[nodiscard]] double height(const Vec3d& q) const { return dot(normal, q) - offset; }
};

/// A label in double. Places are relative to LabelGeometry::centre().
struct PlacedLabel {
  SiteKind kind = SiteKind::face;
  std::uint32_t site = 0;
  Vec3d point;      ///< a corner, an end, the vertex
  Vec3d direction;  ///< of length 1: of a triangle into the solid, of an edge along it
  std::uint32_t first_plane = 0, last_plane = 0;

  /// The square of the distance from its plane, line or point.
  [[nodiscard]] double squared_distance(const Vec3d& q) const { return polar(q, q); }
  /// The polar form of that.
  [[nodiscard]] double polar(const Vec3d& q, const Vec3d& r) const {
    if (kind == SiteKind::face) return height(q) * height(r);
    if (kind == SiteKind::edge) return dot(cross(q - point, direction), cross(r - point, direction));
    return dot(q - point, r - point);
  }
  /// Of a triangle: the signed distance from its plane, positive on the solid's side.
  [[nodiscard]] double height(const Vec3d& q) const { return dot(direction, q - point); }
  /// The closest point of its plane, line or point.
  [[nodiscard]] Vec3d foot(const Vec3d& q) const {
    if (kind == SiteKind::face) return q - direction * height(q);
    if (kind == SiteKind::edge) return point + direction * dot(direction, q - point);
    return point;
  }
  /// The projection of a vector to its plane or line through the origin.
  [[nodiscard]] Vec3d along(const Vec3d& way) const {
    if (kind == SiteKind::face) return way - direction * dot(direction, way);
    return kind == SiteKind::edge ? direction * dot(direction, way) : Vec3d{};
  }
  /// The squared distance along the line q + s e_axis.
  [[nodiscard]] Quadratic along(const Vec3d& q, std::size_t axis) const;
};

class LabelGeometry;

/// The polar form of the difference of the squared distances from two labels' planes, lines or points, with a bound on
/// its rounding.
///
/// With q and r relative to a corner that both have, a squared distance is q . r less the product of the projections to
/// the label's plane or line. So the difference is that of these products, which are small over the corner: there it is
/// known much better than from both distances.
class PolarDifference {
 public:
  PolarDifference(const LabelGeometry& labels, LabelIndex first, LabelIndex second);

  /// That of the first less that of the second.
  [[nodiscard]] double at(const Vec3d& q, const Vec3d& r) const;
  [[nodiscard]] double error(const Vec3d& q, const Vec3d& r) const;

 private:
  const LabelGeometry& labels_;
  const PlacedLabel& first_;
  const PlacedLabel& second_;
  std::optional<Vec3d> corner_;
};

/// All labels in double, and how far what they say may be off.
class LabelGeometry {
 public:
  /// @param mesh, table, sites  of one polyhedron, as SiteLabels takes them.
  LabelGeometry(const MeshView& mesh, const SiteTable& table, const PolyhedronSites& sites, const SiteLabels& labels);

  /// Around the mesh.
  [[nodiscard]] const Box3& box() const { return box_; }
  /// Of the box.
  [[nodiscard]] const Vec3d& centre() const { return centre_; }
  /// Diagonal of the box around the mesh.
  [[nodiscard]] double size() const { return size_; }
  /// How far distances and heights over planes may be off, anywhere in the box.
  [[nodiscard]] double rounding() const { return rounding_; }
  /// How far the difference of two squared distances may be off, with a bound on both distances.
  [[nodiscard]] double rounding_of_squares(double distance) const { return rounding_ * (4 * distance + rounding_); }

  [[nodiscard]] std::size_t count() const { return labels_.size(); }
  [[nodiscard]] const PlacedLabel& operator[](LabelIndex label) const { return labels_[label]; }
  /// Its site; `outside` of the outside.
  [[nodiscard]] std::uint32_t site_of(LabelIndex label) const {
    return label == outside ? outside : labels_[label].site;
  }
  /// The site of an edge or vertex of the mesh: nullopt where it is none, or a thin vertex.
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
  /// Of the planes of a domain those between which the distance from a label's plane, line or point is that of a point
  /// of it: of a triangle all, of an edge those through its ends, of a vertex none.
  [[nodiscard]] std::span<const DomainPlane> ends(LabelIndex label) const {
    const SiteKind kind = labels_[label].kind;
    return planes(label).first(kind == SiteKind::face ? 3 : kind == SiteKind::edge ? 2 : 0);
  }
  /// A plane that tells which of two labels is closer, where both domains hold a point: of two triangles, two vertices,
  /// or two edges with an end in common. Heights may be off by twice the rounding.
  [[nodiscard]] std::optional<Bisector> bisector(LabelIndex a, LabelIndex b) const;
  /// The same of two triangles at points behind the first, where its distance is its height with the other sign;
  /// nullopt where one is none.
  [[nodiscard]] std::optional<Bisector> bisector_behind(LabelIndex a, LabelIndex b) const;
  /// Of a triangle, for each of its sides that is a convex edge; other.outside where it is not.
  [[nodiscard]] std::span<const Bisector, 3> bisectors(LabelIndex triangle) const {
    return std::span<const Bisector, 3>(bisectors_.data() + std::size_t{3} * triangle, 3);
  }
  /// The corners of a label, relative to the centre: three, two or one.
  [[nodiscard]] std::span<const Vec3d> corners(LabelIndex label) const {
    const std::size_t count = labels_[label].kind == SiteKind::face ? 3 : labels_[label].kind == SiteKind::edge ? 2 : 1;
    return std::span(corners_[label]).first(count);
  }
  /// The point of a triangle, edge or vertex that is closest.
  [[nodiscard]] Vec3d closest_point(LabelIndex label, const Vec3d& q) const;
  /// Whether two labels are triangles on both sides of a reflex edge.
  [[nodiscard]] bool share_reflex_edge(LabelIndex a, LabelIndex b) const;
  /// A vertex of the mesh that two labels have for a corner.
  [[nodiscard]] std::optional<std::uint32_t> common_vertex(LabelIndex a, LabelIndex b) const;
  [[nodiscard]] bool has_corner(LabelIndex label, const Vec3d& corner) const;
  /// The vertices of the mesh that are a label's corners, as corners() lists them.
  [[nodiscard]] std::span<const std::uint32_t> vertices(LabelIndex label) const {
    return std::span(vertices_[label]).first(corners(label).size());
  }
  [[nodiscard]] bool has_vertex(LabelIndex label, std::uint32_t v) const {
    const std::span<const std::uint32_t> own = vertices(label);
    return std::find(own.begin(), own.end(), v) != own.end();
  }
  /// Where a vertex of the mesh is, relative to the centre.
  [[nodiscard]] Vec3d place(std::uint32_t v) const { return places_[v]; }
  /// Whether a label is an edge or vertex of a site, or the site of it: what is closest changes from one to the other
  /// only at planes of their domains.
  [[nodiscard]] bool are_incident(std::uint32_t site, LabelIndex label) const;
  /// The same of two sites.
  [[nodiscard]] bool are_neighbours(std::uint32_t site, std::uint32_t other) const;
  /// Vertices whose cones are thinner than this many radians: their regions count as part of walls.
  static constexpr double thin = 1e-3;
  [[nodiscard]] std::span<const LabelIndex> thin_vertices() const { return thin_vertices_; }
  /// The outside is none.
  [[nodiscard]] bool is_thin(LabelIndex label) const {
    return std::binary_search(thin_vertices_.begin(), thin_vertices_.end(), label);
  }
  /// Thin vertices with cones below this are closest nowhere, as far as labels tell: dents by rounding in faces that
  /// are flat but for that. No grid in double could meet their regions.
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
  std::vector<LabelIndex> label_of_edge_, label_of_vertex_;  ///< `outside` where there is none, or an unseen one
  /// Pairs of sites of which one is an edge or vertex of the other, both ways round, sorted.
  std::vector<std::array<std::uint32_t, 2>> neighbours_;
};

/// Of labels among which all are that are closest anywhere in the convex hull of some corners, those that are not ruled
/// out there: a label is where its domain lies outside of the hull, or where it is further away than one point of the
/// surface, the closest one to the middle. Less the square of the distance from a point, the square of that from a
/// plane, line or point is concave, so the corners tell. (Sud 2006, 5.4: governors of a cell.)
///
/// @param corners  relative to the centre of the labels, as `middle`, which lies between them.
/// Cost: O(labels x corners).
[[nodiscard]] std::vector<LabelIndex> governors(const LabelGeometry& labels, std::span<const LabelIndex> among,
                                                std::span<const Vec3d> corners, const Vec3d& middle);

/// The point of some triangles, edges and vertices that is closest to a point, each as a whole.
/// @param among  not empty.
[[nodiscard]] Vec3d closest_surface_point(const LabelGeometry& labels, std::span<const LabelIndex> among,
                                          const Vec3d& q);

}  // namespace blum::voronoi
