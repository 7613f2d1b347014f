// Blum: Voronoi diagrams of convex polyhedra as complexes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "blum/complex/complex.hpp"
#include "blum/core/context.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "blum/voronoi/polyhedron_sites.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "voronoi/planes/convex_faces.hpp"
#include "voronoi/planes/plane_structure.hpp"

namespace blum::voronoi {

/// A convex body and its diagram.
struct ConvexBody {
  ConvexFaces faces;
  PlaneStructure structure;
};

/// The bodies of a polyhedron, all convex.
struct ConvexBodies {
  std::vector<ConvexBody> bodies;
  double flatness = 0;  ///< largest ConvexFaces::flatness of a body
  double joined = 0;    ///< largest distance within which junctions may have been joined
  double moved = 0;     ///< bound on how far the diagram has moved thereby
};

/// Returns the diagrams of the bodies of a polyhedron, or nothing if one is not convex.
///
/// Parts of a diagram within 8 times `flatness` are joined, at small angles also within 64 times
/// (restore_degenerate()). The distance grows until the joined diagram has the right Euler number, to at most 1e-4 of
/// the size. If joined faces do not form a convex polyhedron, the triangles of a convex body are used as given.
/// @param flatness  as for convex_faces(); rounding_of_coordinates() if not given.
/// @throws Cancelled.
[[nodiscard]] std::optional<ConvexBodies> convex_bodies(const MeshView& mesh, const SiteTable& table,
                                                        const PolyhedronSites& sites, std::optional<double> flatness,
                                                        const Context& context);

/// Returns the complex of the diagrams, with the columns of VoronoiComplex. Each sheet consists of triangles between
/// its junctions, and for sheets with more than four sides, of a vertex in the middle.
[[nodiscard]] Complex plane_complex(const MeshView& mesh, const SiteTable& table, const ConvexBodies& bodies,
                                    VoronoiPart part);

}  // namespace blum::voronoi
