// Blum: traced Voronoi diagrams as complexes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "voronoi/traced/traced_sites.hpp"
#include "voronoi/traced/traced_structure.hpp"

namespace blum::voronoi {

/// Returns the complex of a traced structure, with the columns of VoronoiComplex and the column `junction`. Nothing if
/// a sheet cannot be divided into triangles.
/// @param chord  largest distance of the middles of edges and triangles from curved seams and sheets, > 0, mesh units.
/// @param longest  inner edges of triangles, and pieces of seams, are at most about as long, > 0, mesh units.
/// @throws Cancelled.
[[nodiscard]] std::optional<Complex> traced_complex(const MeshView& mesh, const SiteTable& table,
                                                    const TracedSites& sites, const TracedStructure& structure,
                                                    VoronoiPart part, double chord, double longest,
                                                    const Context& context);

}  // namespace blum::voronoi
