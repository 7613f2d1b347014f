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

/// What ends at a vertex v that is a site, or in which two reflex edges in one line meet (a passing vertex).
///
/// Next to a vertex v the diagram is a cone. The region of v is bounded there by walls between
/// it and some of its edges, one for each facet of the dual cone; these meet in rays of the cone, of which some are
/// normals of faces. A passing vertex has no region: between both edges lies a wall, in the plane across them. The
/// region of a thin vertex counts as a line; that of one around which all edges are reflex is a line around which all
/// walls are dropped.
struct ReflexCorner {
  std::vector<std::uint32_t> edges;  ///< sites
  /// Directions of length 1, of the two rays between which each of their facets lies.
  std::vector<std::array<Vec3d, 2>> rays;
  std::vector<std::uint32_t> faces;  ///< sites, of the normals
  bool is_passing = false;           ///< then there are two edges, and two faces
  bool is_thin = false;  ///< then its edges are reflex or flat, the first ones are listed, no faces, and a ray twice

  /// Into how many parts the medial axis falls next to v: around v, walls that are kept are a forest, and Euler's
  /// formula counts its trees. None where all edges are reflex; more than one only meet in v.
  [[nodiscard]] std::int64_t axis_parts() const {
    if (is_passing || is_thin) return 0;
    return static_cast<std::int64_t>(edges.size()) - static_cast<std::int64_t>(faces.size());
  }
};

/// That of each vertex of a mesh, empty where it is neither, or a thin vertex with convex edges.
[[nodiscard]] std::vector<ReflexCorner> reflex_corners(const MeshView& mesh, const SiteTable& table,
                                                       const PolyhedronSites& sites, const LabelGeometry& labels);

/// Which walls a part of the diagram does without. Regions on both sides of one count as joined across it.
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

  /// The vertex of the mesh that is a site.
  [[nodiscard]] std::uint32_t vertex_of(std::uint32_t site) const {
    return sites_.reflex_vertices[site - first_vertex_];
  }

  /// Whether walls between two sites, or a site and the outside, are left out: the surface is, and from a medial axis
  /// what lies between a face and its reflex edges, an edge and its ends, or two edges in one line with a common end,
  /// where both footprints are one point.
  [[nodiscard]] bool drops(std::uint32_t first, std::uint32_t second) const;
  /// The vertex of the mesh in which two edges in one line meet: nullopt where sites are no such edges.
  [[nodiscard]] std::optional<std::uint32_t> passing_vertex(std::uint32_t edge, std::uint32_t other) const;
  /// Thin vertices at the ends of an edge around which all walls are dropped.
  [[nodiscard]] std::span<const std::array<std::uint32_t, 2>> thin_ends(std::uint32_t edge) const;
  /// The faces on both sides of an edge: sites.
  [[nodiscard]] std::array<std::uint32_t, 2> faces_of(std::uint32_t edge) const;
  /// The vertex of the mesh whose thin region an event lies in, where that counts as a line that is dropped.
  [[nodiscard]] std::optional<std::uint32_t> dropped_thin(LabelIndex thin) const {
    if (!is_medial() || thin == outside) return std::nullopt;
    const std::uint32_t v = vertex_of(labels_[thin].site);
    return corners_[v].is_thin ? std::optional(v) : std::nullopt;
  }
  /// By vertices of the mesh.
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
  std::uint32_t vertex = 0;         ///< of the mesh
  std::vector<std::size_t> events;  ///< of the border that lie in it, by their numbers in SquareCells
};

/// A part of the diagram in a resolved square.
///
/// Pieces are joined across dropped walls. As each is connected and reaches the border, two of them have one arc in
/// common at most: two would enclose a third piece. Where joined pieces go around something, it is a point around which
/// all walls are dropped: where a reflex edge pierces the square, or the normal of a face at a vertex (`corners`); or
/// it is a component of the part that lies strictly inside (then `is_told` is false). A thin region that reaches the
/// border in k places is convex, so it joins the k chains of pieces between these as k - 1 arcs would.
struct PartSquare {
  std::vector<std::array<std::uint32_t, 2>> arcs;  ///< dropped: the pieces on both sides, the smaller one first
  std::vector<std::array<std::uint32_t, 2>>
      corners;                           ///< the site of a face, or `outside` of a thin vertex; a vertex of the mesh
  std::vector<std::uint32_t> component;  ///< of the part, of each event; `outside` of dropped ones
  std::uint32_t component_count = 0;
  std::vector<ThinRegion> thin;  ///< that reach the border
  bool is_told = true;
};

[[nodiscard]] PartSquare part_square(const SquareCells& cells, const GridSquare& square, const PartRule& rule);

}  // namespace blum::voronoi
