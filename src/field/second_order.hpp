// Blum: the second order of a field. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "field/second_request.hpp"

namespace blum {

/// Finishes nodes that float32 left open: exact distance and site.
void settle_second(const std::vector<std::size_t>& nodes, const MeshView& mesh, const SiteTable& sites,
                   const SecondRequest& request, const Context& context);

}  // namespace blum
