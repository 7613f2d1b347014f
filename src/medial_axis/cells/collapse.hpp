// Blum: collapses of cubical complexes in order of importance. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "medial_axis/cells/cell_complex.hpp"
#include "medial_axis/cells/importance.hpp"

namespace blum::detail {

/// Elementary collapse: the removal of a cell and of a face that belongs to no other cell.
struct Removal {
  Cell cell;
  Cell face;
  /// Degrees: the largest importance of a face removed so far, this one included.
  float level;
};

/// Result of collapsing a complex, and the order of its further removals.
struct CollapseOrder {
  /// The complex after all removals of level zero. It contains no cubes, and cells of importance zero only if the
  /// homotopy type requires them.
  CellComplex base;
  /// The removals after those that led to `base`, ascending by level, up to the largest requested level. The removals
  /// with level <= theta turn `base` into the complex at theta.
  std::vector<Removal> removals;
};

/// Depths of the cells of a complex in the solid, mesh units.
struct CellDepths {
  std::span<const float> of_voxels;      ///< for each voxel of the lattice, x fastest; negative outside the solid
  std::span<const float> of_extra = {};  ///< for each extra cell
};

/// Removes pairs of an extra cell and its free face until there are none. The free face must also be an extra cell, and
/// have importance zero. The result has the homotopy type of the complex and contains all its voxels.
void collapse_extra(CellComplex& complex, const Importance& importance);

/// Collapses a complex until nothing can be removed. Cubes are removed first, then squares, edges and vertices. Faces
/// of least importance come first; among faces of equal importance, the shallowest face comes first. Each step is an
/// elementary collapse. So all intermediate complexes have the homotopy type of the given one, for any importance and
/// depth (Liu, Chambers, Letscher, Ju 2010; Chaussard, Couprie 2009).
/// @param importance  degrees. A cell must be at least as important as its cofaces.
/// @param most_level  degrees; removals of larger importance are not listed.
/// @throws Cancelled. Cost: about linear in the number of cells, and n log n for n cells of importance above 0.
[[nodiscard]] CollapseOrder collapse(CellComplex complex, const CellDepths& depths, double depth_step,
                                     const Importance& importance, double most_level, const Context& context);

}  // namespace blum::detail
