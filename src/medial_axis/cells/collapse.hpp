// Blum: collapses of cubical complexes in order of importance. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "medial_axis/cells/cell_complex.hpp"
#include "medial_axis/cells/importance.hpp"

namespace blum::detail {

/// Elementary collapse: removes a cell together with a face that no other cell has.
struct Removal {
  Cell cell;
  Cell face;
  /// Degrees: the largest importance among this removal and those before it.
  float level;
};

/// Result of collapsing a complex, and the order of its further removals.
struct CollapseOrder {
  /// Contains no cubes and no cells of importance zero that homotopy does not need.
  CellComplex base;
  /// Removals that follow, by level, up to the largest requested one. After those of level <= theta, the base has
  /// become the complex at theta.
  std::vector<Removal> removals;
};

/// Depths of the cells of a complex in the solid, mesh units.
struct CellDepths {
  std::span<const float> of_voxels;      ///< of the lattice, x fastest; negative outside the solid
  std::span<const float> of_extra = {};  ///< of each extra cell
};

/// Removes extra cells of importance zero together with free faces that are also extra, until none is left. The result
/// has the homotopy type of the complex and contains all its voxels.
void collapse_extra(CellComplex& complex, const Importance& importance);

/// Collapses a complex until nothing can be removed. Cubes are removed first, then squares, edges and vertices. The
/// least important cells come first, and the shallowest among equals. Each step is an elementary collapse. So
/// every complex on the way has the homotopy type of the first, whatever the numbers are (Liu, Chambers, Letscher, Ju
/// 2010; Chaussard, Couprie 2009).
/// @param importance  of cells, in degrees; at least that of their cofaces.
/// @param most_level  degrees; removals of larger importance are not listed.
/// @throws Cancelled. Cost: about linear in the cells, n log n in the important ones.
[[nodiscard]] CollapseOrder collapse(CellComplex complex, const CellDepths& depths, double depth_step,
                                     const Importance& importance, double most_level, const Context& context);

}  // namespace blum::detail
