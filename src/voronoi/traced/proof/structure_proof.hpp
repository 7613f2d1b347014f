// Blum: proof that junctions and seams exist as they were traced. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "voronoi/traced/traced_sites.hpp"
#include "voronoi/traced/traced_structure.hpp"

namespace blum::voronoi {

/// A junction or a piece of a seam that is not proven.
struct OpenPlace {
  Vec3d at;  ///< relative to TracedSites::origin()
  double size = 0;
  std::vector<TracedSites::Index> sites;
  VoronoiDoubt doubt = VoronoiDoubt::close;
};

struct StructureProof {
  double moved = 0;           ///< as SiteBounds::moved()
  std::size_t junctions = 0;  ///< inside the solid
  std::size_t proven_junctions = 0;
  std::size_t seams = 0;
  std::size_t proven_seams = 0;
  std::vector<OpenPlace> open;  ///< junctions first
};

/// Proves junctions and seams of a traced structure.
///
/// A junction is proven if a ball contains exactly one point with these closest sites. No other part of the border may
/// be closest to a point of the ball. As many seams must end there as in general position. The equations are then
/// one to one in the ball (Newton and Kantorovich), so sheets and seams in it are those of linear functions. A seam is
/// proven if cylinders around its pieces each contain exactly one curve with its closest sites, from one end to the
/// other. No other part of the border may be closest there. At a vertex of the polyhedron, the diagram near it is a
/// cone, so one section proves the piece that ends there. (docs/theory/voronoi.md, "Proven places".)
///
/// The proof holds for every polyhedron with the same flat faces whose corners lie within SiteBounds::corner_error().
/// @param mesh   of the sites.
/// @param table  of the mesh.
/// @throws Cancelled. Cost: 5 to 20 us per piece; a seam has about ten pieces.
[[nodiscard]] StructureProof prove_structure(const TracedSites& sites, const MeshView& mesh, const SiteTable& table,
                                             const TracedStructure& structure, const Context& context);

}  // namespace blum::voronoi
