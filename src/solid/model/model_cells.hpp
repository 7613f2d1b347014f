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

/// An end of an interval: on a triangle, or at a corner that is inside.
struct IntervalEnd {
  Vec3d point;
  std::optional<std::uint32_t> triangle = {};
};

/// A regular cell complex. A vertex stands for a component of the solid in a cube, an edge for one in a square. A
/// polygon stands for an interval of an edge of the grid, a polyhedron for a corner inside.
struct ModelCells {
  std::vector<std::uint8_t> dimension;
  std::vector<std::uint32_t> first_face;         ///< first of each cell's faces, and the end
  std::vector<std::uint32_t> faces;              ///< cells of one dimension less
  std::vector<Vec3d> witness;                    ///< a point of each cell's component
  std::vector<std::array<IntervalEnd, 2>> ends;  ///< of each extra cell: ends of a polygon's interval, the lower first

  std::vector<std::optional<Box3>> boxes;  ///< of each extra cell: the box of a vertex in a split cube

  [[nodiscard]] std::size_t size() const { return dimension.size(); }
  [[nodiscard]] std::span<const std::uint32_t> faces_of(std::uint32_t cell) const {
    return std::span(faces).subspan(first_face[cell], first_face[cell + 1] - first_face[cell]);
  }
};

/// The cells of a model that differ from the union of the closed voxels around the grid's inside nodes. A cell of the
/// lattice of these voxels stands for the dual cell of the grid: a voxel for a node, and so on.
struct ExtraModelCells {
  ModelCells cells;  ///< those for which no cell of the voxels stands; faces are numbered as `first` explains
  /// Faces below this are cells of the lattice. Others are this plus the number of an extra cell.
  std::uint32_t first = 0;
  /// For the first extra cells: the cell of the voxels that would stand for each. The others are parts of split boxes.
  std::vector<Cell> places;
  /// Cells of the voxels that are not in the model, rising. The model has extra cells there.
  std::vector<Cell> replaced;
  /// Extra cells, by number, and cells of the voxels of which they are faces; rising.
  std::vector<std::array<std::uint32_t, 2>> cofaces;
};
/// Returns the cells of a model that the voxels do not give.
/// @param voxels  their lattice: one more node along each axis than the grid's lattice.
/// @throws Cancelled; InvalidGrid.
[[nodiscard]] ExtraModelCells extra_model_cells(const SurfaceMesh& mesh, const CutGrid& grid,
                                                std::span<const RefinedRegion> regions, const CellLattice& voxels,
                                                const Context& context);

/// Returns the cells of a model. Cost: about 100 bytes and 0.2 us per cell.
/// @throws Cancelled.
[[nodiscard]] ModelCells model_cells(const SurfaceMesh& mesh, const CutGrid& grid,
                                     std::span<const RefinedRegion> regions, const Context& context);

/// Returns the numbers of cells by dimension, without listing the cells.
[[nodiscard]] std::array<std::int64_t, 4> count_model_cells(const CutGrid& grid,
                                                            std::span<const RefinedRegion> regions);

}  // namespace blum::detail
