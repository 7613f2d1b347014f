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
  std::vector<FailingCube> lost;  ///< cubes that passed before, and do not: none, unless that was decided too early
};

/// A vertex for each component in a cube that passes, in a square without children and on a grid edge; a triangle for
/// each three of which one contains the next. Columns as VoronoiComplex says. Vertices settle on what they stand for:
/// walls, seams, junctions, the surface.
[[nodiscard]] Assembled assemble(const CellTree& tree, std::span<const CellId> leaves, const CubeTest& test,
                                 const VoronoiSolid& solid, const Context& context);

/// Those of some leaves, rising, in which the triangles of assemble() cross the surface.
[[nodiscard]] std::vector<CellId> crossing_cubes(const CellTree& tree, std::span<const CellId> leaves,
                                                 const CubeTest& test, const VoronoiSolid& solid,
                                                 const Context& context);

}  // namespace blum::voronoi
