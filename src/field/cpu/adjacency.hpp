// Blum: neighbours and faces of each vertex and edge, and the order in which sites are stored.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/sites.hpp"

namespace blum::cpu {

inline constexpr std::uint32_t no_index = 0xffffffff;

/// Connectivity of a mesh. Connectivity depends only on the mesh's indices, so it stays valid while the mesh deforms.
struct Adjacency {
  /// Vertices that a triangle, segment or point uses, ascending.
  std::vector<std::uint32_t> named_vertices;
  /// Other ends of the edges at vertex v: neighbours[first_neighbour[v] .. first_neighbour[v + 1]).
  std::vector<std::uint32_t> first_neighbour;
  std::vector<std::uint32_t> neighbours;
  /// Two triangles of each edge. Further triangles are left out, because bounds stay valid without them. no_index fills
  /// missing entries.
  std::vector<std::array<std::uint32_t, 2>> edge_faces;
};

void build_adjacency(const MeshView& mesh, const SiteTable& sites, const Context& context, Adjacency& out);

/// Orders of the sites in which sites that lie close together follow each other. Vertices in use are sorted along a
/// Morton curve. Edges and faces are sorted by the position of their first vertex on the curve. Ties are sorted by site
/// id.
struct SiteOrder {
  std::vector<std::uint32_t> vertices;
  std::vector<std::uint32_t> edges;
  std::vector<std::uint32_t> faces;
  /// Index in `vertices` of each vertex of the mesh; 0 for vertices not in use.
  std::vector<std::uint32_t> rank;
};

/// Computes the orders.
/// @param positions  one per vertex of the mesh, in the normalised frame (within [-1, 1] on each axis for vertices in
/// use).
void order_sites(const MeshView& mesh, const SiteTable& sites, const Adjacency& adjacency,
                 std::span<const Vec3d> positions, const Context& context, SiteOrder& out);

}  // namespace blum::cpu
