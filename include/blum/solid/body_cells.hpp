// Blum: cellular model of a body, relative to the voxels of a grid. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "blum/complex/incidence.hpp"
#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/cell_lattice.hpp"
#include "blum/grid/grid_spec.hpp"
#include "blum/grid/voxel_set.hpp"
#include "blum/solid/cellular_model.hpp"

namespace blum {

/// Cell of a model that does not correspond to a cell of the voxels.
struct ExtraCell {
  /// End of an interval on a line between two nodes.
  struct End {
    Vec3d point;                                 ///< Mesh units.
    std::optional<std::uint32_t> triangle = {};  ///< Triangle of the surface; none if a node of the grid is the end.
  };
  int dimension = 0;  ///< 0 to 3.
  /// Cell of the voxels at this place; none if cubes of the model were split there.
  std::optional<Cell> place = {};
  Vec3d witness;            ///< Point of the component of the solid that the cell represents, mesh units.
  std::optional<Box3> box;  ///< Vertices in split cubes: what is left of the cube, mesh units.
  std::array<End, 2> ends;  ///< Polygons: ends of the interval that it represents.
};

/// Cellular model of a body (see CellularModel) over a grid. It consists of the closed voxels around the nodes inside,
/// and of the differences from their union. Where walls or gaps are thinner than a voxel, the model has cells that no
/// voxel has, or several cells in place of one. All other cells are cells of the lattice of voxels. A node inside is a
/// voxel, a line between nodes a square, a square of the grid an edge, and a cube a vertex.
struct BodyCells {
  CellLattice lattice;         ///< Lattice of the voxels. Voxel (i, j, k) surrounds node (i, j, k) of the grid.
  VoxelSet inside;             ///< Nodes inside. Exact, with ties broken as in CellularModel.
  std::vector<Cell> replaced;  ///< Cells of the voxels that extra cells replace in the model, ascending.
  std::vector<ExtraCell> extra;
  /// Faces of each extra cell, of one dimension less. Numbers below `first` are cells of the lattice; others are
  /// `first` plus the number of an extra cell.
  IndexRows faces;
  std::uint32_t first = 0;
  /// Pairs of an extra cell and a cell of the lattice of which it is a face: numbers of both.
  std::vector<std::array<std::uint32_t, 2>> cofaces;

  /// Places where a component is not contractible. If any exists, the model does not have the body's homotopy type.
  std::vector<ModelFailure> failures;
};

/// Computes the cellular model of a body.
/// @param body  closed, manifold, without self-intersections, facing outwards.
/// @param grid  its axes are those of space. All of the body lies more than one step inside its outermost nodes.
/// @param finer  boxes in which the model must be finer than necessary, mesh units. Boxes of the model that contain
///               part of the surface, and share inner points with one of these, are split. This ends when no side is
///               longer than about a quarter of the longest side of that box.
/// @throws InvalidMesh, InvalidGrid, OutOfMemory, Cancelled as Solid::model().
/// Cost: that of Solid::model().
[[nodiscard]] BodyCells body_cells(const TriangleMesh& body, const GridSpec& grid, std::span<const Box3> finer,
                                   const Context& context = {});

}  // namespace blum
