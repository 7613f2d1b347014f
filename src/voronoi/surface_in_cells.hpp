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

/// Exact tests of a mesh against the cells of a grid. The grid's planes count as moved by infinitely small amounts
/// (grid_predicates.hpp).
class SurfaceInCells {
 public:
  SurfaceInCells(const MeshView& mesh, const SiteTable& table, const Lattice& lattice)
      : mesh_(mesh), table_(table), lattice_(lattice) {}

  [[nodiscard]] const SiteTable& table() const { return table_; }
  /// Returns true if an edge of the mesh passes through a square.
  [[nodiscard]] bool pierces(std::uint32_t edge, const GridSquare& square) const;
  [[nodiscard]] bool is_in(std::uint32_t vertex, const GridCube& cube) const;
  /// Returns the edges of some triangles, rising.
  [[nodiscard]] std::vector<std::uint32_t> edges_of(std::span<const std::uint32_t> triangles) const;

 private:
  const MeshView mesh_;
  const SiteTable& table_;
  const Lattice& lattice_;
};

/// The arcs in which the surface meets a square. Each runs along triangles from an event of the border to another.
struct SurfaceChains {
  std::vector<std::array<std::uint32_t, 2>> ends;       ///< the events at both ends of each
  std::vector<std::array<std::uint32_t, 2>> triangles;  ///< chain, triangle: sorted
  std::vector<std::uint32_t> edges;                     ///< edges of the mesh that pierce the square, rising
};

/// Returns the arcs, or nullopt if the surface in the square has a closed curve.
[[nodiscard]] std::optional<SurfaceChains> surface_chains(const CellTree& tree, const SurfaceInCells& surface,
                                                          const GridSquare& square);

}  // namespace blum::voronoi
