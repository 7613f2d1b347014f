// Blum: places where the surface passes squares and cubes, exactly. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "voronoi/cell_tree.hpp"

namespace blum::voronoi {

/// Exact tests of a mesh against the cells of a grid. The planes of the grid are treated as moved by infinitely small
/// amounts, so that nothing lies exactly in them (grid_predicates.hpp).
class SurfaceInCells {
 public:
  SurfaceInCells(const MeshView& mesh, const SiteTable& table, const Lattice& lattice)
      : mesh_(mesh), table_(table), lattice_(lattice) {}

  [[nodiscard]] const SiteTable& table() const { return table_; }
  /// Returns true if an edge of the mesh passes through a square.
  [[nodiscard]] bool pierces(std::uint32_t edge, const GridSquare& square) const;
  [[nodiscard]] bool is_in(std::uint32_t vertex, const GridCube& cube) const;
  /// Returns the edges of the given triangles, each once, in ascending order.
  [[nodiscard]] std::vector<std::uint32_t> edges_of(std::span<const std::uint32_t> triangles) const;

 private:
  const MeshView mesh_;
  const SiteTable& table_;
  const Lattice& lattice_;
};

/// The arcs (chains) in which the surface meets a square. Each arc passes from triangle to triangle, between two events
/// of the border.
struct SurfaceChains {
  std::vector<std::array<std::uint32_t, 2>> ends;       ///< for each arc: the events at its ends
  std::vector<std::array<std::uint32_t, 2>> triangles;  ///< (arc, triangle), sorted
  std::vector<std::uint32_t> edges;                     ///< edges of the mesh that pierce the square, ascending
};

/// Returns the arcs; nullopt if the surface has a closed curve in the square.
[[nodiscard]] std::optional<SurfaceChains> surface_chains(const CellTree& tree, const SurfaceInCells& surface,
                                                          const GridSquare& square);

}  // namespace blum::voronoi
