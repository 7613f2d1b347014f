// Blum: signs of fields, as planned. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/field/field.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "field/sign/policy.hpp"

namespace blum::sign {

/// Negates the distances of nodes inside.
/// @param plan   of this mesh; with Method::crossings or Method::sums.
/// @param field  unsigned distances of this mesh, off by at most 1e-6 of the diagonal of the box around mesh and grid.
/// The same bytes for any number of threads.
void apply_winding(const Plan& plan, const MeshView& mesh, const SiteTable& sites, const Context& context,
                   Field& field);

/// Negates the distances of nodes whose closest site, as the field has it, faces away from them.
/// @return  nodes without a site, rising.
[[nodiscard]] std::vector<std::size_t> apply_pseudonormals(const MeshView& mesh, const SiteTable& sites,
                                                           const Context& context, Field& field);

}  // namespace blum::sign
