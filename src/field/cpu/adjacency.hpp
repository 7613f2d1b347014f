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

/// Connectivity of a mesh. It depends on the mesh's indices alone, so a deforming mesh keeps it.
struct Adjacency {
  /// Vertices that a triangle, segment or point names, ascending.
  std::vector<std::uint32_t> named_vertices;
  /// Other ends of the edges at vertex v: neighbours[first_neighbour[v] .. first_neighbour[v + 1]).
  std::vector<std::uint32_t> first_neighbour;
  std::vector<std::uint32_t> neighbours;
  /// Up to two triangles of each edge (more are not needed for a valid bound); no_index if there are fewer.
  std::vector<std::array<std::uint32_t, 2>> edge_faces;
};

void build_adjacency(const MeshView& mesh, const SiteTable& sites, const Context& context, Adjacency& out);

/// Spatially coherent orders of the sites. Named vertices follow a Morton curve, and edges and faces their first vertex
/// on it. Ties keep the sites' own order.
struct SiteOrder {
  std::vector<std::uint32_t> vertices;
  std::vector<std::uint32_t> edges;
  std::vector<std::uint32_t> faces;
  /// Place of each vertex of the mesh in `vertices`; 0 if it is not named.
  std::vector<std::uint32_t> rank;
};

/// Orders the sites.
/// @param positions  one per vertex of the mesh, in the normalised frame ([-1, 1] on each axis if named).
void order_sites(const MeshView& mesh, const SiteTable& sites, const Adjacency& adjacency,
                 std::span<const Vec3d> positions, const Context& context, SiteOrder& out);

}  // namespace blum::cpu
