// Blum: a part of the Voronoi diagram in a square. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/voronoi/polyhedron_sites.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "voronoi/cell_tree.hpp"
#include "voronoi/label_geometry.hpp"
#include "voronoi/square_cells.hpp"

namespace blum::voronoi {

/// Which walls a part of the diagram does without. Regions on both sides of one count as joined across it.
class PartRule {
 public:
  PartRule(VoronoiPart part, const PolyhedronSites& sites, const LabelGeometry& labels)
      : part_(part),
        first_edge_(static_cast<std::uint32_t>(sites.face_count)),
        first_vertex_(static_cast<std::uint32_t>(sites.face_count + sites.reflex_edges.size())),
        labels_(labels) {}

  [[nodiscard]] bool is_all() const { return part_ == VoronoiPart::all; }
  [[nodiscard]] bool is_medial() const { return part_ == VoronoiPart::medial_axis; }
  [[nodiscard]] bool is_face(std::uint32_t site) const { return site < first_edge_; }
  [[nodiscard]] bool is_edge(std::uint32_t site) const { return site >= first_edge_ && site < first_vertex_; }
  [[nodiscard]] bool is_vertex(std::uint32_t site) const { return site >= first_vertex_ && site != outside; }

  /// Whether walls between two sites, or a site and the outside, are left out: the surface is, and from a medial axis
  /// what lies between a face and its reflex edges, an edge and its ends, where both footprints are one point.
  [[nodiscard]] bool drops(std::uint32_t first, std::uint32_t second) const;

 private:
  VoronoiPart part_;
  std::uint32_t first_edge_, first_vertex_;
  const LabelGeometry& labels_;
};

/// A part of the diagram in a resolved square.
///
/// Pieces are joined across dropped walls. As each is connected and reaches the border, two of them have one arc in
/// common at most: two would enclose a third piece. Where joined pieces go around something, it is a point around which
/// all walls are dropped: where a reflex edge pierces the square, or the normal of a face at a reflex vertex
/// (`corners`); or it is a component of the part that lies strictly inside (then `is_told` is false).
struct PartSquare {
  std::vector<std::array<std::uint32_t, 2>> arcs;     ///< dropped: the pieces on both sides, the smaller one first
  std::vector<std::array<std::uint32_t, 2>> corners;  ///< sites: face, vertex
  std::vector<std::uint32_t> component;               ///< of the part, of each event; `outside` of dropped ones
  std::uint32_t component_count = 0;
  bool is_told = true;
};

[[nodiscard]] PartSquare part_square(const SquareCells& cells, const GridSquare& square, const PartRule& rule);

}  // namespace blum::voronoi
