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
  double largest_diagonal = 0;    ///< of cubes with a component, mesh units
  std::vector<FailingCube> lost;  ///< cubes that passed earlier but not now; empty unless they were accepted too early
};

/// Builds the complex of the components in leaves. It has a vertex for each component in a passing cube, in a square
/// without children and on a grid edge. It has a triangle for each three of these of which one contains the next.
/// Columns: see VoronoiComplex. Vertices are moved onto their walls, seams, junctions or the surface.
[[nodiscard]] Assembled assemble(const CellTree& tree, std::span<const CellId> leaves, const CubeTest& test,
                                 const VoronoiSolid& solid, const Context& context);

/// Returns the leaves, rising, in which triangles of assemble() cross the surface.
[[nodiscard]] std::vector<CellId> crossing_cubes(const CellTree& tree, std::span<const CellId> leaves,
                                                 const CubeTest& test, const VoronoiSolid& solid,
                                                 const Context& context);

}  // namespace blum::voronoi
