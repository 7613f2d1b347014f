// Blum: the surface in a square of the grid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "voronoi/cell_tree.hpp"
#include "voronoi/surface_in_cells.hpp"

namespace blum::voronoi {

/// The arcs in which the surface meets a square: each runs along triangles from an event of the border to another.
struct SurfaceChains {
  std::vector<std::array<std::uint32_t, 2>> ends;       ///< the events at both ends of each
  std::vector<std::array<std::uint32_t, 2>> triangles;  ///< chain, triangle: sorted
  std::vector<std::uint32_t> edges;                     ///< of the mesh that pierce the square, rising
};

/// nullopt where the surface in the square has a closed curve.
[[nodiscard]] std::optional<SurfaceChains> surface_chains(const CellTree& tree, const SurfaceInCells& surface,
                                                          const GridSquare& square);

}  // namespace blum::voronoi
