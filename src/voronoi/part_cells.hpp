// Blum: reflex corners, and a part of the Voronoi diagram in a square. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "voronoi/cell_tree.hpp"
#include "voronoi/label_geometry.hpp"
#include "voronoi/square_cells.hpp"

namespace blum::voronoi {

/// Walls and lines at a vertex v that is a site, or a passing vertex: one at which two collinear reflex edges meet.
///
/// Near a vertex v the diagram is a cone. There, the region of v is the dual cone of its edges. Each facet of this cone
/// is a wall between v and an edge. These walls meet in rays of the cone, and some rays are normals of faces. A passing
/// vertex has no region. Instead, a wall lies between its two edges, in the plane at a right angle to them. The region
/// of a thin vertex is treated as a line. If a thin vertex has no convex edge, all walls around that line are dropped.
struct ReflexCorner {
  std::vector<std::uint32_t> edges;  ///< sites of the edges
  /// For each edge: unit vectors along the two rays that bound its facet.
  std::vector<std::array<Vec3d, 2>> rays;
  std::vector<std::uint32_t> faces;  ///< sites of the faces whose normals are rays
  bool is_passing = false;           ///< true for a passing vertex: two edges and two faces are listed
  bool is_thin = false;  ///< true for a thin vertex without convex edges: reflex edges and a ray (twice) are listed

  /// Returns the number of components of the medial axis near v, without v itself. On a small sphere around v, the kept
  /// walls form a forest, and Euler's formula counts its trees. The number is 0 if all edges are reflex. If it is 2 or
  /// more, the components meet only at v.
  [[nodiscard]] std::int64_t axis_parts() const {
    if (is_passing || is_thin) return 0;
    return static_cast<std::int64_t>(edges.size()) - static_cast<std::int64_t>(faces.size());
  }
};

/// Returns the corner at each vertex of a mesh. It is empty if the vertex is neither a site nor passing, or if it is
/// thin with a convex edge.
[[nodiscard]] std::vector<ReflexCorner> reflex_corners(const MeshView& mesh, const SiteTable& table,
                                                       const PolyhedronSites& sites, const LabelGeometry& labels);

/// Rule for the walls that the requested part of the diagram drops. The regions on both sides of a dropped wall are
/// treated as joined.
class PartRule {
 public:
  PartRule(VoronoiPart part, const PolyhedronSites& sites, const LabelGeometry& labels,
           std::span<const ReflexCorner> corners)
      : part_(part),
        first_edge_(static_cast<std::uint32_t>(sites.face_count)),
        first_vertex_(static_cast<std::uint32_t>(sites.face_count + sites.reflex_edges.size())),
        sites_(sites),
        labels_(labels),
        corners_(corners),
        passing_(passing_pairs(corners)),
        thin_ends_(thin_ends_of(corners)) {}

  [[nodiscard]] bool is_all() const { return part_ == VoronoiPart::all; }
  [[nodiscard]] bool is_medial() const { return part_ == VoronoiPart::medial_axis; }
  [[nodiscard]] bool is_face(std::uint32_t site) const { return site < first_edge_; }
  [[nodiscard]] bool is_edge(std::uint32_t site) const { return site >= first_edge_ && site < first_vertex_; }
  [[nodiscard]] bool is_vertex(std::uint32_t site) const { return site >= first_vertex_ && site != outside; }

  /// Returns the vertex of the mesh for the site of a vertex.
  [[nodiscard]] std::uint32_t vertex_of(std::uint32_t site) const {
    return sites_.reflex_vertices[site - first_vertex_];
  }

  /// Returns true if walls between two sites, or between a site and the outside, are dropped. Every part except `all`
  /// drops the surface. The medial axis also drops walls between a face and its own reflex edges, and between an edge
  /// and its own ends. It also drops walls between the two edges at a passing vertex. Points of these walls have only
  /// one footprint.
  [[nodiscard]] bool drops(std::uint32_t first, std::uint32_t second) const;
  /// Returns the passing vertex at which two edges meet; nullopt for other pairs of sites.
  [[nodiscard]] std::optional<std::uint32_t> passing_vertex(std::uint32_t edge, std::uint32_t other) const;
  /// Returns pairs of the given edge and a thin vertex at one of its ends. Thin vertices with
  /// convex edges are left out. All walls are dropped only around thin vertices without convex edges.
  [[nodiscard]] std::span<const std::array<std::uint32_t, 2>> thin_ends(std::uint32_t edge) const;
  /// Returns the sites of the faces on both sides of an edge.
  [[nodiscard]] std::array<std::uint32_t, 2> faces_of(std::uint32_t edge) const;
  /// Returns the mesh vertex of a thin label of an event, if its region counts as a dropped line; otherwise nullopt.
  [[nodiscard]] std::optional<std::uint32_t> dropped_thin(LabelIndex thin) const {
    if (!is_medial() || thin == outside) return std::nullopt;
    const std::uint32_t v = vertex_of(labels_[thin].site);
    return corners_[v].is_thin ? std::optional(v) : std::nullopt;
  }
  /// Returns the corner at a vertex of the mesh.
  [[nodiscard]] const ReflexCorner& corner(std::uint32_t v) const { return corners_[v]; }

 private:
  /// The two edges at a passing vertex, the smaller one first, and the vertex.
  using PassingPair = std::array<std::uint32_t, 3>;
  [[nodiscard]] static std::vector<PassingPair> passing_pairs(std::span<const ReflexCorner> corners);
  [[nodiscard]] static std::vector<std::array<std::uint32_t, 2>> thin_ends_of(std::span<const ReflexCorner> corners);

  VoronoiPart part_;
  std::uint32_t first_edge_, first_vertex_;
  const PolyhedronSites& sites_;
  const LabelGeometry& labels_;
  std::span<const ReflexCorner> corners_;
  std::vector<PassingPair> passing_;                     ///< sorted
  std::vector<std::array<std::uint32_t, 2>> thin_ends_;  ///< (edge, vertex), sorted
};

/// A thin region that is treated as a line and meets the border of a square.
struct ThinRegion {
  std::uint32_t vertex = 0;         ///< vertex of the mesh
  std::vector<std::size_t> events;  ///< events of the border in the region, as indices in SquareCells
};

/// The requested part of the diagram in a resolved square.
///
/// Pieces are joined across dropped walls. Each piece is connected and reaches the border. So two pieces share at most
/// one arc, because two arcs would enclose a third piece. Joined pieces may surround a point around which all walls are
/// dropped. At this point, a reflex edge or the normal of a face at a vertex (`corners`) pierces the square. If joined
/// pieces surround anything else, it is a component of the part strictly inside the square; then `is_decided` is false.
/// A thin region that reaches the border in k events is convex. It joins the k chains of pieces between these events,
/// just as k - 1 arcs would.
struct PartSquare {
  std::vector<std::array<std::uint32_t, 2>> arcs;  ///< dropped arcs: pieces on both sides, the smaller one first
  std::vector<std::array<std::uint32_t, 2>>
      corners;                           ///< (site of a face, or `outside` for a thin vertex; vertex of the mesh)
  std::vector<std::uint32_t> component;  ///< for each event: component of the part, or `outside` if dropped
  std::uint32_t component_count = 0;
  std::vector<ThinRegion> thin;  ///< thin regions that reach the border
  bool is_decided = true;
};

[[nodiscard]] PartSquare part_square(const SquareCells& cells, const GridSquare& square, const PartRule& rule);

}  // namespace blum::voronoi
