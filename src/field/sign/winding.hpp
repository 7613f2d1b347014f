// Blum: the sign of a field by sums of winding numbers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "blum/core/context.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/geometry/winding_number.hpp"

namespace blum {

/// What the sign of a field has cost.
struct WindingSignCounts {
  std::size_t queries = 0;     ///< winding numbers evaluated
  std::size_t components = 0;  ///< sets of nodes that were known to share a sign
};

/// Negates the distances of nodes inside: those whose winding number is above 1/2.
///
/// Nodes that certainly share a sign are found first and ask once: distances are 1-Lipschitz, so no triangle separates
/// two nodes whose distances add up to more than their distance from each other; along such steps the winding number
/// changes only by the field of the mesh's boundary, which WindingNumber::gradient_bound() bounds. Steps are joined as
/// long as the sum of their bounds leaves the side decidable. On a closed mesh the bound is 0; near the rim of a hole
/// every node asks for itself, so that nothing floods through it.
///
/// @param field  unsigned distances of this mesh, off by at most 1e-6 of the diagonal of the box around mesh and grid;
///               with a band, +band beyond it. Only `distance` is changed.
/// @return       the same for any number of threads.
/// Cost: about two passes over the distances, and one winding number for every set of nodes.
WindingSignCounts apply_winding_sign(Field& field, const MeshView& mesh, const WindingNumber& winding,
                                     const Context& context);
/// The same with the winding numbers built on the way.
WindingSignCounts apply_winding_sign(Field& field, const MeshView& mesh, const SiteTable& sites,
                                     const Context& context);

}  // namespace blum
