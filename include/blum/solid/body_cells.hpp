// Blum: the cellular model of a body, beside the voxels of a grid. SPDX-License-Identifier: Apache-2.0
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

/// A cell of a model that no cell of the voxels stands for.
struct ExtraCell {
  /// Where an interval of a line between two nodes begins or ends.
  struct End {
    Vec3d point;                                 ///< mesh units
    std::optional<std::uint32_t> triangle = {};  ///< of the surface; none where a node of the grid is the end
  };
  int dimension = 0;  ///< 0 to 3
  /// The cell of the voxels that lies there; none where the model's cubes were split.
  std::optional<Cell> place = {};
  Vec3d witness;            ///< a point of the solid's component that the cell stands for, mesh units
  std::optional<Box3> box;  ///< vertices in split cubes: of what is left of the cube, mesh units
  std::array<End, 2> ends;  ///< polygons: of the interval that it stands for
};

/// The cellular model of a body (see CellularModel) over a grid, as the closed voxels around the nodes that are inside,
/// and what differs from their union: where walls or gaps are thinner than a voxel, the model has cells that no voxel
/// has, and several in the place of one. All else are cells of the lattice of voxels: a voxel for a node inside, a
/// square for a line between nodes, an edge for a square of the grid, a vertex for a cube.
struct BodyCells {
  CellLattice lattice;         ///< of the voxels: voxel (i, j, k) is the one around node (i, j, k) of the grid
  VoxelSet inside;             ///< the nodes inside; exact, ties broken as CellularModel does
  std::vector<Cell> replaced;  ///< cells of the voxels that are none of the model, rising: it has extra cells there
  std::vector<ExtraCell> extra;
  /// Of each extra cell, of one dimension less: cells of the lattice, where they are below `first`, else `first` and
  /// the number of an extra cell.
  IndexRows faces;
  std::uint32_t first = 0;
  /// Numbers of extra cells, and cells of the lattice that these are faces of.
  std::vector<std::array<std::uint32_t, 2>> cofaces;

  /// Places where a component is not contractible: where there are any, the model has not the body's homotopy type.
  std::vector<ModelFailure> failures;
};

/// @param body  closed, manifold, without self-intersections, facing outwards.
/// @param grid  its axes are those of space; all of the body lies more than one step inside of its outermost nodes.
/// @param finer  where the model shall be finer than it must be, mesh units: boxes that hold some of the surface, and
///               share inner points with one of these, are split until none of their sides is longer than about a
///               quarter of its longest one.
/// @throws InvalidMesh, InvalidGrid, OutOfMemory, Cancelled as Solid::model(). Cost: as that.
[[nodiscard]] BodyCells body_cells(const TriangleMesh& body, const GridSpec& grid, std::span<const Box3> finer,
                                   const Context& context = {});

}  // namespace blum
