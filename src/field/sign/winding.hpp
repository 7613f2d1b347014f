// Blum: the sign of a field by sums of winding numbers. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "blum/core/context.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/geometry/winding_number.hpp"

namespace blum {

/// Counts that describe the cost of finding a field's signs.
struct WindingSignCounts {
  std::size_t queries = 0;     ///< winding numbers evaluated
  std::size_t components = 0;  ///< sets of nodes that certainly share a sign
};

/// Negates the distances of nodes inside. Nodes are inside if their winding number is above 1/2.
///
/// Nodes that certainly share a sign are grouped first, and one node per group is evaluated. Distances are 1-Lipschitz:
/// no triangle separates two nodes whose distances add up to more than the distance between them. Along such steps the
/// winding number changes only through the mesh's boundary. WindingNumber::gradient_bound() bounds this change. Steps
/// are joined while the sum of their bounds still excludes a change of side. On a closed mesh, the bound is 0. Near the
/// rim of a hole every node is evaluated, so that no sign leaks through the hole.
///
/// @param field  unsigned distances of this mesh; nodes beyond the band have +band. The error may be at most 1e-6 of
///               the diagonal of the box around mesh and grid. Only `distance` is changed.
/// @return       counts of the work. Results do not depend on the number of threads.
/// Cost: about two passes over the distances, and one winding number for every set of nodes.
WindingSignCounts apply_winding_sign(Field& field, const MeshView& mesh, const WindingNumber& winding,
                                     const Context& context);
/// Does the same as the function above, but also builds the WindingNumber.
WindingSignCounts apply_winding_sign(Field& field, const MeshView& mesh, const SiteTable& sites,
                                     const Context& context);

}  // namespace blum
