// Blum: the complex of components of walls in the cells of an octree. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "voronoi/cell_tree.hpp"
#include "voronoi/cube_test.hpp"
#include "voronoi/voronoi_solid.hpp"

namespace blum::voronoi {

struct Assembled {
  Complex complex;
  double largest_diagonal = 0;    ///< largest diagonal of a cube with a component, mesh units
  std::vector<FailingCube> lost;  ///< cubes that passed an earlier test but fail now; should be empty
};

/// Builds the complex of the components of walls and surface in leaves. It has a vertex for each component in a passing
/// cube, in a square without children, and on a grid edge. It has a triangle for each three components, in a cube, a
/// square and an edge, of which each contains the next. Columns: see VoronoiComplex. Vertices are moved onto their
/// walls, seams, junctions or the surface.
[[nodiscard]] Assembled assemble(const CellTree& tree, std::span<const CellId> leaves, const CubeTest& test,
                                 const VoronoiSolid& solid, const Context& context);

/// Returns the leaves in which triangles of assemble() cross the surface, in ascending order.
[[nodiscard]] std::vector<CellId> crossing_cubes(const CellTree& tree, std::span<const CellId> leaves,
                                                 const CubeTest& test, const VoronoiSolid& solid,
                                                 const Context& context);

}  // namespace blum::voronoi
