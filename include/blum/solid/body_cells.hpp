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

/// Cell of a cellular model that is not a cell of the lattice of voxels.
struct ExtraCell {
  /// End of an interval on the segment between two neighbouring nodes.
  struct End {
    Vec3d point;                                 ///< Mesh units.
    std::optional<std::uint32_t> triangle = {};  ///< Triangle of the surface at this end; unset if the end is a node.
  };
  int dimension = 0;  ///< 0 to 3.
  /// Cell of the lattice of voxels to which this cell corresponds; unset if cubes of the model were split there.
  std::optional<Cell> place = {};
  Vec3d witness;            ///< Point of the component of the solid that the cell represents, mesh units.
  std::optional<Box3> box;  ///< For vertices in split cubes: the part of the cube in which the vertex lies, mesh units.
  std::array<End, 2> ends;  ///< For polygons: ends of the interval that the polygon represents.
};

/// Cellular model of a body (see CellularModel) over a grid. The model is stored in two parts. One part is the set of
/// voxels whose nodes are inside the body. The other part is the list of cells in which the model differs from the
/// union of these closed voxels. Where walls or gaps are thinner than a voxel, the model has extra cells. An extra cell
/// either belongs to no voxel, or is one of several cells that replace one cell of the lattice. All other cells of the
/// model are cells of the lattice of voxels. In the lattice of voxels, a voxel stands for a node inside the body, and a
/// square stands for an edge of the grid. An edge of the lattice stands for a square of the grid, and a vertex for a
/// cube of the grid.
struct BodyCells {
  CellLattice lattice;         ///< Lattice of the voxels. Voxel (i, j, k) surrounds node (i, j, k) of the grid.
  VoxelSet inside;             ///< Nodes inside the body; exact. Ties: docs/theory/solid.md.
  std::vector<Cell> replaced;  ///< Cells of `lattice` that extra cells replace in the model, ascending.
  std::vector<ExtraCell> extra;
  /// For each extra cell, its faces: the cells of one dimension less in its border. A number below `first` is a cell of
  /// `lattice`. Any other number is `first` plus an index in `extra`.
  IndexRows faces;
  std::uint32_t first = 0;
  /// Pairs of an extra cell (index in `extra`) and a cell of `lattice` that has the extra cell as a face.
  std::vector<std::array<std::uint32_t, 2>> cofaces;

  /// Boxes in which a component of the body is not contractible. If there is such a box, the model does not have the
  /// body's homotopy type.
  std::vector<ModelFailure> failures;
};

/// Computes the cellular model of a body.
/// @param body  closed, manifold, without self-intersections, facing outwards.
/// @param grid  its axes must be the coordinate axes. The body must lie in the box of the outermost nodes, more than
///              one step away from its sides.
/// @param finer  boxes in which the model must be finer than necessary, mesh units. A box of the model is split if it
///               contains part of the surface and overlaps one of the boxes in `finer`. Splitting ends when the longest
///               side of the model's box is at most about a quarter of the longest side of the box in `finer`.
/// @throws InvalidMesh, InvalidGrid, OutOfMemory, Cancelled as Solid::model().
/// Cost: that of Solid::model().
[[nodiscard]] BodyCells body_cells(const TriangleMesh& body, const GridSpec& grid, std::span<const Box3> finer,
                                   const Context& context = {});

}  // namespace blum
