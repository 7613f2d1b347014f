// Blum: regions and walls in a square, from its border. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "voronoi/cell_tree.hpp"
#include "voronoi/label_geometry.hpp"

namespace blum::voronoi {

/// An arc of a grid edge without children, between two of its events, or between one and an end.
struct EdgeArc {
  CellId edge = no_cell;
  std::uint32_t index = 0;  ///< counted from the lower end

  [[nodiscard]] friend auto operator<=>(const EdgeArc&, const EdgeArc&) = default;
};

/// The regions of sites and of the outside in a resolved square, and the components of walls and surface.
///
/// The border of the square is a cyclic word: runs between events. All regions touch the border, those of a site are
/// connected, and the surface shows which runs of the outside belong together. So the word alone determines the rest.
/// The boundary of a region leads from each of its runs to the next one and so joins the events there. This is the
/// Kreweras complement of a non-crossing partition.
struct SquareCells {
  struct Run {
    LabelIndex label = outside;
    std::uint32_t piece = 0;
    std::uint32_t body = 0;  ///< component of the solid, or of the outside, that it lies in
  };
  struct Piece {
    std::uint32_t site = outside;  ///< `outside` for the outside
    std::uint32_t body = 0;
  };
  struct ArcOfRun {
    EdgeArc arc;
    std::uint32_t run = 0;
  };

  std::vector<std::uint32_t> events;  ///< around the border; event k lies between runs k and k + 1, the last before 0
  std::vector<LabelIndex> thin;       ///< of each event, the only vertex whose thin region it is in, if any
  std::vector<Run> runs;              ///< as many as events, but one if no events exist
  std::vector<Piece> pieces;
  std::uint32_t body_count = 0;
  std::vector<std::uint32_t> component;  ///< of each event
  std::uint32_t component_count = 0;
  std::vector<ArcOfRun> arcs;

  /// Pieces on both sides of an event, by its number here, and their sites.
  [[nodiscard]] std::uint32_t piece_before(std::size_t event) const { return runs[event].piece; }
  [[nodiscard]] std::uint32_t piece_behind(std::size_t event) const { return runs[(event + 1) % runs.size()].piece; }
  [[nodiscard]] std::uint32_t site_before(std::size_t event) const { return pieces[piece_before(event)].site; }
  [[nodiscard]] std::uint32_t site_behind(std::size_t event) const { return pieces[piece_behind(event)].site; }
};

/// Components of events around a border, if parts of the border in one region are joined in the square. The boundary of
/// a region leads from each of its runs to the next one.
struct EventComponents {
  std::vector<std::uint32_t> of;  ///< of each event
  std::uint32_t count = 0;
};

/// Joins events around a border to components.
/// @param region_of_run  region of each run, numbered from 0, with one run for each event. Run k lies before event k,
///   and behind the event before it. Regions do not cross. Among four runs around the border, the first and third are
///   never of one region if the others are of another one.
[[nodiscard]] EventComponents join_events(std::span<const std::uint32_t> region_of_run);

[[nodiscard]] SquareCells square_cells(const CellTree& tree, const LabelGeometry& labels, const GridSquare& square);

}  // namespace blum::voronoi
