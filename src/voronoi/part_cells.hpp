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

/// Walls and lines at a vertex v that is a site, or in which two reflex edges in one line meet (a passing vertex).
///
/// Next to a vertex v the diagram is a cone. The region of v is bounded there by walls between v and some of its edges,
/// one for each facet of the dual cone. These walls meet in rays of the cone, some of which are normals of faces. A
/// passing vertex has no region: a wall lies between both edges, in the plane across them. The region of a thin vertex
/// counts as a line. If all its edges are reflex, all walls around that line are dropped.
struct ReflexCorner {
  std::vector<std::uint32_t> edges;  ///< sites
  /// Directions, of length 1, of the two rays between which the facet of each edge lies.
  std::vector<std::array<Vec3d, 2>> rays;
  std::vector<std::uint32_t> faces;  ///< sites, of the normals
  bool is_passing = false;           ///< if so, two edges and two faces are listed
  bool is_thin = false;  ///< if so, its edges are reflex or flat; reflex ones are listed, no faces, and a ray twice

  /// Returns the number of parts of the medial axis next to v. Around v, the walls that are kept form a forest, and
  /// Euler's formula counts its trees. The number is 0 if all edges are reflex. Two or more parts meet in v only.
  [[nodiscard]] std::int64_t axis_parts() const {
    if (is_passing || is_thin) return 0;
    return static_cast<std::int64_t>(edges.size()) - static_cast<std::int64_t>(faces.size());
  }
};

/// Returns the corner at each vertex of a mesh. It is empty if the vertex is of neither kind, or is thin with convex
/// edges.
[[nodiscard]] std::vector<ReflexCorner> reflex_corners(const MeshView& mesh, const SiteTable& table,
                                                       const PolyhedronSites& sites, const LabelGeometry& labels);

/// Rule for the walls that a part of the diagram drops. Regions on both sides of a dropped wall count as joined across
/// it.
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

  /// Returns the vertex of the mesh that is a site.
  [[nodiscard]] std::uint32_t vertex_of(std::uint32_t site) const {
    return sites_.reflex_vertices[site - first_vertex_];
  }

  /// Returns true if walls between two sites, or between a site and the outside, are dropped. Every part but `all`
  /// drops the surface. A medial axis also drops walls between a face and its reflex edges, and between an edge and its
  /// ends. It drops walls between two edges in one line with a common end, too. Both footprints of these walls are one
  /// point.
  [[nodiscard]] bool drops(std::uint32_t first, std::uint32_t second) const;
  /// Returns the vertex of the mesh in which two edges in one line meet; nullopt for other sites.
  [[nodiscard]] std::optional<std::uint32_t> passing_vertex(std::uint32_t edge, std::uint32_t other) const;
  /// Returns the thin vertices at the ends of an edge around which all walls are dropped, each with the edge.
  [[nodiscard]] std::span<const std::array<std::uint32_t, 2>> thin_ends(std::uint32_t edge) const;
  /// Returns the sites of the faces on both sides of an edge.
  [[nodiscard]] std::array<std::uint32_t, 2> faces_of(std::uint32_t edge) const;
  /// Returns the vertex of the mesh whose thin region an event lies in, if that region counts as a dropped line.
  [[nodiscard]] std::optional<std::uint32_t> dropped_thin(LabelIndex thin) const {
    if (!is_medial() || thin == outside) return std::nullopt;
    const std::uint32_t v = vertex_of(labels_[thin].site);
    return corners_[v].is_thin ? std::optional(v) : std::nullopt;
  }
  /// Returns the corner at a vertex of the mesh.
  [[nodiscard]] const ReflexCorner& corner(std::uint32_t v) const { return corners_[v]; }

 private:
  /// Two edges, the smaller one first, and a vertex.
  using PassingPair = std::array<std::uint32_t, 3>;
  [[nodiscard]] static std::vector<PassingPair> passing_pairs(std::span<const ReflexCorner> corners);
  [[nodiscard]] static std::vector<std::array<std::uint32_t, 2>> thin_ends_of(std::span<const ReflexCorner> corners);

  VoronoiPart part_;
  std::uint32_t first_edge_, first_vertex_;
  const PolyhedronSites& sites_;
  const LabelGeometry& labels_;
  std::span<const ReflexCorner> corners_;
  std::vector<PassingPair> passing_;                     ///< sorted
  std::vector<std::array<std::uint32_t, 2>> thin_ends_;  ///< edge, vertex: sorted
};

/// A thin region in a square that counts as a line, and meets the square's border.
struct ThinRegion {
  std::uint32_t vertex = 0;         ///< vertex of the mesh
  std::vector<std::size_t> events;  ///< events of the border that lie in it, by their numbers in SquareCells
};

/// A part of the diagram in a resolved square.
///
/// Pieces are joined across dropped walls. Each piece is connected and reaches the border, so two of them share at most
/// one arc: two arcs would enclose a third piece. Joined pieces may go around a point around which all walls are
/// dropped. There a reflex edge pierces the square, or the normal of a face at a vertex (`corners`). Anything else that
/// they go around is a component of the part that lies strictly inside; then `is_decided` is false. A thin region that
/// reaches the border in k places is convex. So it joins the k chains of pieces between these as k - 1 arcs would.
struct PartSquare {
  std::vector<std::array<std::uint32_t, 2>> arcs;  ///< dropped: the pieces on both sides, the smaller one first
  std::vector<std::array<std::uint32_t, 2>>
      corners;                           ///< the site of a face, or `outside` for a thin vertex; a vertex of the mesh
  std::vector<std::uint32_t> component;  ///< of the part, for each event; `outside` for dropped ones
  std::uint32_t component_count = 0;
  std::vector<ThinRegion> thin;  ///< regions that reach the border
  bool is_decided = true;
};

[[nodiscard]] PartSquare part_square(const SquareCells& cells, const GridSquare& square, const PartRule& rule);

}  // namespace blum::voronoi
