// Blum: sites that may be closest inside a polyhedron. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Kind of an edge by the angle inside the solid. The exact side of a plane decides.
enum class EdgeTurn : std::uint8_t {
  convex,  ///< Below 180 degrees.
  flat,    ///< 180 degrees: both triangles lie in one plane.
  reflex,  ///< Above 180 degrees.
};

/// Faces, reflex edges and reflex vertices of a polyhedron, which are the sites of the Voronoi diagram inside it. No
/// point inside is closest to any other part of the surface: next to a convex edge, one of its faces is closer.
struct PolyhedronSites {
  /// Face of each triangle. Triangles of one plane that share edges form one face. Faces are numbered by their smallest
  /// triangle.
  std::vector<std::uint32_t> face_of;
  std::size_t face_count = 0;
  std::vector<EdgeTurn> turn;  ///< One for each edge of the SiteTable.
  /// Two triangles of each edge. The first one traverses it from its smaller to its larger vertex.
  std::vector<std::array<std::uint32_t, 2>> triangles_of;
  std::vector<std::uint32_t> reflex_edges;  ///< Edges of the SiteTable, ascending.
  /// Vertices to which a cone of points inside is closest, ascending.
  std::vector<std::uint32_t> reflex_vertices;
};

/// Finds the sites of a polyhedron, exactly for the given triangles.
///
/// Let v be a vertex with edges to w_1, ..., w_n. Only the surface near v counts here. Then v is closest to the points
/// q with (q - v) . (w_i - v) <= 0 for all i, the dual cone of its edges. If that cone has an interior, it meets the
/// surface near v in v alone. So it lies inside the solid or outside. Each of its extreme planes belongs to an edge
/// that is extreme among all of them, and is reflex or convex accordingly. Half-spaces cut the cone one after the
/// other. Exact signs of determinants of three edges decide everything. (Sud 2006, 5.3: sites of a polyhedron.)
///
/// @param mesh   closed, facing away from its inside, without crossings. Coordinates have magnitude 1e-80 to 1e100, or
///               are 0. Shells may touch in vertices.
/// @param sites  table of this mesh.
/// @throws InvalidMesh if an edge does not have two triangles that traverse it in opposite directions, or a triangle
/// has no area; Cancelled.
/// Cost: about 0.1 us per edge; at vertices with reflex edges up to the square of their degree.
[[nodiscard]] PolyhedronSites polyhedron_sites(const MeshView& mesh, const SiteTable& sites,
                                               const Context& context = {});

}  // namespace blum
