// Blum: collapses of cubical complexes in the order of an importance. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "medial_axis/cells/cell_complex.hpp"
#include "medial_axis/cells/importance.hpp"

namespace blum::detail {

/// An elementary collapse: a cell, and a face of it that no other cell had, leave together.
struct Removal {
  Cell cell;
  Cell face;
  /// Degrees: the largest importance among this removal and those before it.
  float level;
};

/// What collapsing left, and in which order the rest of it can go.
struct CollapseOrder {
  /// The cells of importance zero that homotopy does not need are gone, and all cubes.
  CellComplex base;
  /// What follows, by level, up to the largest one asked for: after those of level <= theta, what is left of the base
  /// is the complex at theta.
  std::vector<Removal> removals;
};

/// How deep in the solid the cells of a complex lie, mesh units.
struct CellDepths {
  std::span<const float> of_voxels;      ///< of the lattice, x fastest; negative beyond the solid
  std::span<const float> of_extra = {};  ///< of each extra cell
};

/// Removes extra cells of importance zero together with faces that are extra, too, while there are such that are free.
/// The result has the homotopy type of the complex, and all its voxels.
void collapse_extra(CellComplex& complex, const Importance& importance);

/// Collapses a complex: cubes first, then squares, edges and vertices, least important first and outermost first among
/// equals, until nothing can be removed. Each step is an elementary collapse, so that every complex on the way has the
/// homotopy type of the first (Liu, Chambers, Letscher, Ju 2010; Chaussard, Couprie 2009), whatever the numbers are.
/// What is shallow goes first.
/// @param importance  of cells, in degrees; at least that of their cofaces.
/// @param most_level  degrees: of what is more important, no order is told.
/// @throws Cancelled. Cost: about linear in the cells, n log n in the important ones.
[[nodiscard]] CollapseOrder collapse(CellComplex complex, const CellDepths& depths, double depth_step,
                                     const Importance& importance, double most_level, const Context& context);

}  // namespace blum::detail
