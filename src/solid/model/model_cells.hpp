// Blum: the cells of a cellular model, listed one by one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "solid/model/cut_grid.hpp"
#include "solid/model/refined_region.hpp"
#include "solid/model/surface_mesh.hpp"

namespace blum::detail {

/// An end of an interval: on a triangle, or at an inside corner (then `triangle` is not set).
struct IntervalEnd {
  Vec3d point;
  std::optional<std::uint32_t> triangle = {};
};

/// A regular cell complex, dual to the grid. A vertex stands for a component of the solid in a cube, an edge for a
/// component in a square. A polygon stands for an interval of an edge of the grid, a polyhedron for a node inside the
/// solid.
struct ModelCells {
  std::vector<std::uint8_t> dimension;
  std::vector<std::uint32_t> first_face;         ///< for each cell: index of its first face; then the number of faces
  std::vector<std::uint32_t> faces;              ///< cells, one dimension lower
  std::vector<Vec3d> witness;                    ///< for each cell: a point of its component
  std::vector<std::array<IntervalEnd, 2>> ends;  ///< for extra cells: a polygon's interval, lower end first

  std::vector<std::optional<Box3>> boxes;  ///< for extra cells: the box of a vertex in a split cube

  [[nodiscard]] std::size_t size() const { return dimension.size(); }
  [[nodiscard]] std::span<const std::uint32_t> faces_of(std::uint32_t cell) const {
    return std::span(faces).subspan(first_face[cell], first_face[cell + 1] - first_face[cell]);
  }
};

/// The differences between a model and the union of the closed voxels around the grid's inside nodes. A cell of the
/// voxels' lattice stands for the dual cell of the grid. For example, a voxel stands for a node, and a face of a voxel
/// for an edge.
struct ExtraModelCells {
  ModelCells cells;  ///< the extra cells; see `first` for the numbers of their faces
  /// A face with a number below this is a cell of the lattice. Any other face is the extra cell whose number is the
  /// face's number minus `first`.
  std::uint32_t first = 0;
  /// For each extra cell outside split cubes, which come first: the cell of the voxels that would stand for it.
  std::vector<Cell> places;
  /// Cells of the voxels that are not in the model, in ascending order. In the model, extra cells replace these cells.
  std::vector<Cell> replaced;
  /// Pairs of an extra cell (by number) and a cell of the voxels that has the extra cell as a face; in ascending order.
  std::vector<std::array<std::uint32_t, 2>> cofaces;
};
/// Returns the differences between a model and its voxels.
/// @param voxels  lattice of the voxels, with one more node along each axis than the grid's lattice.
/// @throws Cancelled; InvalidGrid.
[[nodiscard]] ExtraModelCells extra_model_cells(const SurfaceMesh& mesh, const CutGrid& grid,
                                                std::span<const RefinedRegion> regions, const CellLattice& voxels,
                                                const Context& context);

/// Returns the cells of a model. Cost: about 100 bytes and 0.2 us per cell.
/// @throws Cancelled.
[[nodiscard]] ModelCells model_cells(const SurfaceMesh& mesh, const CutGrid& grid,
                                     std::span<const RefinedRegion> regions, const Context& context);

/// Returns the number of cells of each dimension 0 to 3, without listing the cells.
[[nodiscard]] std::array<std::int64_t, 4> count_model_cells(const CutGrid& grid,
                                                            std::span<const RefinedRegion> regions);

}  // namespace blum::detail
