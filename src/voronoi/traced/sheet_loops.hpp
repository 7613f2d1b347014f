// Blum: boundaries of sheets between seams. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "voronoi/traced/seam_graph.hpp"
#include "voronoi/traced/traced_sites.hpp"
#include "voronoi/traced/traced_structure.hpp"

namespace blum::voronoi {

/// Boundaries of sheets.
struct SheetLoops {
  std::vector<TracedStructure::Sheet> sheets;       ///< each with one loop
  std::vector<std::vector<SeamGraph::Side>> sides;  ///< the walls beside the curves of each loop
};

/// Follows the boundaries of sheets. At each junction, the walls beside its curves are paired. Two walls are one sheet
/// if they have the same sites, and no curve lies between them.
/// @throws TraceProblem if a wall has no partner, or is the partner of two.
[[nodiscard]] SheetLoops sheet_loops(const TracedSites& sites, const TracedStructure& structure);

}  // namespace blum::voronoi
