// Blum: the cells of a cellular model, one by one. SPDX-License-Identifier: Apache-2.0
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

/// A regular cell complex: a vertex for each component of the solid in a cube, an edge for each in a square, a polygon
/// for each interval of an edge of the grid, a polyhedron for each corner inside.
struct ModelCells {
  std::vector<std::uint8_t> dimension;
  std::vector<std::uint32_t> first_face;         ///< of each cell, and the end
  std::vector<std::uint32_t> faces;              ///< of one dimension less
  std::vector<Vec3d> witness;                    ///< of each cell: a point of its component
  std::vector<std::array<IntervalEnd, 2>> ends;  ///< of each extra cell: of a polygon's interval, the lower one first

  std::vector<std::optional<Box3>> boxes;  ///< of each extra cell: of vertices in split cubes

  [[nodiscard]] std::size_t size() const { return dimension.size(); }
  [[nodiscard]] std::span<const std::uint32_t> faces_of(std::uint32_t cell) const {
    return std::span(faces).subspan(first_face[cell], first_face[cell + 1] - first_face[cell]);
  }
};

/// The cells of a model that differ from the union of the closed voxels around the grid's nodes that are inside. A cell
/// of the lattice of these voxels stands for the cell of the grid that is dual to it: a voxel for a node, and so on.
struct ExtraModelCells {
  ModelCells cells;  ///< those that no cell of the voxels stands for; faces are numbers as `face_of` has them
  /// Faces are cells of the lattice where below this, else this and the number of an extra cell.
  std::uint32_t first = 0;
  /// Of the first extra cells the cell of the voxels that would stand for each; the others are parts of split boxes.
  std::vector<Cell> places;
  /// Cells of the voxels that are none of the model, rising: the model has extra cells there.
  std::vector<Cell> replaced;
  /// Extra cells, by number, and cells of the voxels that these are faces of: rising.
  std::vector<std::array<std::uint32_t, 2>> cofaces;
};
/// @param voxels  their lattice: one more node along each axis than the grid's lattice. @throws Cancelled; InvalidGrid.
[[nodiscard]] ExtraModelCells extra_model_cells(const SurfaceMesh& mesh, const CutGrid& grid,
                                                std::span<const RefinedRegion> regions, const CellLattice& voxels,
                                                const Context& context);

/// @throws Cancelled. Cost: about 100 bytes and 0.2 us for each cell.
[[nodiscard]] ModelCells model_cells(const SurfaceMesh& mesh, const CutGrid& grid,
                                     std::span<const RefinedRegion> regions, const Context& context);

/// The numbers of cells by dimension, without naming them one by one.
[[nodiscard]] std::array<std::int64_t, 4> count_model_cells(const CutGrid& grid,
                                                            std::span<const RefinedRegion> regions);

}  // namespace blum::detail
