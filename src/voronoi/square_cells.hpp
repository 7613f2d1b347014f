// Blum: regions and walls in a square, from its border. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "voronoi/cell_tree.hpp"
#include "voronoi/label_geometry.hpp"

namespace blum::voronoi {

/// An arc of a grid edge without children: its part between two neighbouring events, or between an event and an end.
struct EdgeArc {
  CellId edge = no_cell;
  std::uint32_t index = 0;  ///< index of the arc on the edge, counted from the lower end

  [[nodiscard]] friend auto operator<=>(const EdgeArc&, const EdgeArc&) = default;
};

/// The contents of a resolved square: regions of sites and of the outside, and components of walls and surface.
///
/// Events divide the border of the square into runs, each of one site or of the outside. All regions touch the border,
/// and the region of a site is connected. Arcs of the surface determine which runs of the outside are connected. So the
/// cyclic sequence of runs determines everything else. The boundary of a region connects the end of each of its runs to
/// the start of the next. So it joins the events at both. This gives the Kreweras complement of a non-crossing
/// partition.
struct SquareCells {
  struct Run {
    LabelIndex label = outside;
    std::uint32_t piece = 0;
    std::uint32_t body = 0;  ///< component of the solid, or of the outside, that contains the run
  };
  struct Piece {
    std::uint32_t site = outside;  ///< site of the region; `outside` for the outside
    std::uint32_t body = 0;
  };
  struct ArcOfRun {
    EdgeArc arc;
    std::uint32_t run = 0;
  };

  std::vector<std::uint32_t> events;  ///< around the border; event k lies between runs k and k + 1, the last before 0
  std::vector<LabelIndex> thin;       ///< for each event: the thin vertex whose region contains it, if exactly one
  std::vector<Run> runs;              ///< one run for each event; a single run without events
  std::vector<Piece> pieces;
  std::uint32_t body_count = 0;
  std::vector<std::uint32_t> component;  ///< for each event: its component
  std::uint32_t component_count = 0;
  std::vector<ArcOfRun> arcs;

  /// Return the pieces on both sides of an event, and their sites. Events have their indices in `events`.
  [[nodiscard]] std::uint32_t piece_before(std::size_t event) const { return runs[event].piece; }
  [[nodiscard]] std::uint32_t piece_behind(std::size_t event) const { return runs[(event + 1) % runs.size()].piece; }
  [[nodiscard]] std::uint32_t site_before(std::size_t event) const { return pieces[piece_before(event)].site; }
  [[nodiscard]] std::uint32_t site_behind(std::size_t event) const { return pieces[piece_behind(event)].site; }
};

/// Components of events around a border, where the runs of each region are connected inside the square. The boundary of
/// a region connects each of its runs to its next run.
struct EventComponents {
  std::vector<std::uint32_t> of;  ///< for each event: its component
  std::uint32_t count = 0;
};

/// Finds which events around a border belong to the same component.
/// @param region_of_run  for each run its region, numbered from 0. There is one run for each event; run k lies just
///   before event k. Regions must not cross. Take any four runs in order around the border. If the first and third have
///   the same region, the second and fourth must not share another one.
[[nodiscard]] EventComponents join_events(std::span<const std::uint32_t> region_of_run);

[[nodiscard]] SquareCells square_cells(const CellTree& tree, const LabelGeometry& labels, const GridSquare& square);

}  // namespace blum::voronoi
