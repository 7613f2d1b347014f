// Blum: the sites that may be closest inside a polyhedron. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// How the solid turns at an edge, by the exact side of a plane.
enum class EdgeTurn : std::uint8_t {
  convex,  ///< its angle inside the solid is below 180 degrees
  flat,    ///< 180 degrees: both triangles lie in one plane
  reflex,  ///< above 180 degrees
};

/// The faces, reflex edges and reflex vertices of a polyhedron: what its Voronoi diagram inside is one of. No point
/// inside is closest to any other part of the surface: next to a convex edge one of its faces is closer.
struct PolyhedronSites {
  /// Triangles of one plane that share edges are one face: the number of each triangle's face. Faces are numbered by
  /// their smallest triangle.
  std::vector<std::uint32_t> face_of;
  std::size_t face_count = 0;
  std::vector<EdgeTurn> turn;  ///< of each edge of the SiteTable
  /// The two triangles of each edge: the first one traverses it from its smaller to its larger vertex.
  std::vector<std::array<std::uint32_t, 2>> triangles_of;
  std::vector<std::uint32_t> reflex_edges;  ///< edges of the SiteTable, rising
  /// Vertices such that points inside are closest to them that fill a cone: rising.
  std::vector<std::uint32_t> reflex_vertices;
};

/// Finds the sites of a polyhedron, exactly, for the triangles as they are given.
///
/// A vertex v with edges to w_1, ..., w_n is closest to the points q with (q - v) . (w_i - v) <= 0 for all i, as far as
/// the surface next to it goes: the dual cone of its edges. Where that cone has an interior, it meets the surface next
/// to v in v alone, and so lies inside the solid or outside of it; each of its extreme planes belongs to an edge that
/// is extreme among all of them, and is reflex or convex accordingly. The cone is cut by one half-space after the
/// other; signs of determinants of three edges, which are exact, tell all of it. (Sud 2006, 5.3: sites of a
/// polyhedron.)
///
/// @param mesh   closed, facing away from its inside, without crossings; coordinates of magnitude 1e-80 to 1e100, or 0.
///               Shells may touch in vertices.
/// @param sites  the table of this mesh.
/// @throws InvalidMesh where an edge does not have two triangles that traverse it in opposite directions, or a triangle
///         has no area; Cancelled.
/// Cost: about 0.1 us per edge; at vertices with reflex edges up to the square of their degree.
[[nodiscard]] PolyhedronSites polyhedron_sites(const MeshView& mesh, const SiteTable& sites,
                                               const Context& context = {});

}  // namespace blum
