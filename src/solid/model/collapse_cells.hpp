// Blum: collapsing the cells of a model. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "solid/model/model_cells.hpp"

namespace blum::detail {

/// Removes pairs of a cell and a face that only this cell has, from outside, until there are none. What is left has the
/// homotopy type of all; of cells with a homology of dimension 3, such as none that a solid in space gives, polyhedra
/// would be left, which are dropped. Edges and polygons are subdivided at a point of their own, so that corners name
/// them. @throws Cancelled. Cost: near-linear in the cells.
[[nodiscard]] Complex collapse_cells(const ModelCells& cells, const Context& context);

}  // namespace blum::detail
