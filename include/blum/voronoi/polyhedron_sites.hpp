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

/// Kind of an edge, by the angle between its two triangles, measured through the solid. The kind is determined exactly.
enum class EdgeTurn : std::uint8_t {
  convex,  ///< Below 180 degrees.
  flat,    ///< 180 degrees: both triangles lie in one plane.
  reflex,  ///< Above 180 degrees.
};

/// Faces, reflex edges and reflex vertices of a polyhedron, which are the sites of the Voronoi diagram inside it. Only
/// these sites can be closest to a point inside the polyhedron. For example, near a convex edge, a face at the edge is
/// closer than the edge.
struct PolyhedronSites {
  /// For each triangle, the number of its face. Triangles in one plane that are connected through edges form one face.
  /// Faces are numbered in the order of their smallest triangles.
  std::vector<std::uint32_t> face_of;
  std::size_t face_count = 0;
  std::vector<EdgeTurn> turn;  ///< Kind of each edge of the SiteTable.
  /// The two triangles of each edge of the SiteTable. The first triangle traverses the edge from its smaller to its
  /// larger vertex.
  std::vector<std::array<std::uint32_t, 2>> triangles_of;
  std::vector<std::uint32_t> reflex_edges;  ///< Edges of the SiteTable, ascending.
  /// Vertices, ascending. Near each of them, the solid contains a cone of points to which the vertex is the closest
  /// point of the surface.
  std::vector<std::uint32_t> reflex_vertices;
};

/// Finds the sites of a polyhedron, exactly for the given triangles.
///
/// Let v be a vertex with edges to w_1, ..., w_n. Only the surface near v is considered here. The point closest to q is
/// v if (q - v) . (w_i - v) <= 0 for all i. All such points q form the dual cone of the edges. If the cone has an
/// interior, it meets the surface near v only in v. So the part of the cone near v lies either inside or outside the
/// solid. Each face of the cone belongs to an edge at v. All these edges are reflex if the cone lies inside, and convex
/// if it lies outside. To find the cone, space is cut by the half-spaces of the edges. All decisions use exact signs of
/// determinants of three edges. (Sud 2006, 5.3: sites of a polyhedron.)
///
/// @param mesh   closed, facing away from its inside, without crossings. Coordinates must be 0, or have magnitudes of
///               1e-80 to 1e100. Shells may touch in vertices.
/// @param sites  table of this mesh.
/// @throws InvalidMesh if an edge does not have two triangles that traverse it in opposite directions, or a triangle
/// has no area; Cancelled.
/// Cost: about 0.1 us per edge; for a vertex with reflex edges, up to the square of its number of edges.
[[nodiscard]] PolyhedronSites polyhedron_sites(const MeshView& mesh, const SiteTable& sites,
                                               const Context& context = {});

}  // namespace blum
