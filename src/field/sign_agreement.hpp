// Blum: whether the signs of neighbouring nodes are consistent. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "blum/field/field.hpp"

namespace blum {

/// Whether every two adjacent nodes that no triangle separates have the same sign. Distances are 1-Lipschitz, so
/// nothing separates two nodes whose distances add up to more than their spacing.
/// @param diagonal  of the box around mesh and grid: distances may be off by 1e-6 of it.
/// Cost: one pass over the distances.
[[nodiscard]] bool signs_agree(const Field& field, double diagonal, const Context& context);

}  // namespace blum
