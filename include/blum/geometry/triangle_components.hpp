// Blum: connected components of a surface, and the triangles at its edges. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "blum/geometry/sites.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

inline constexpr std::uint32_t no_component = 0xffffffff;

/// Returns true if a triangle uses a vertex twice. Such triangles bound nothing and are ignored in all topology.
[[nodiscard]] inline bool names_vertex_twice(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// Uses of one edge by triangles.
struct EdgeTally {
  std::uint32_t count = 0;     ///< number of uses
  std::int32_t balance = 0;    ///< uses from the smaller to the larger vertex, minus those in the other direction
  std::uint32_t triangle = 0;  ///< one of the triangles that use the edge

  [[nodiscard]] bool is_consistent() const { return count == 2 && balance == 0; }
};
/// Returns the uses of each edge of the table. Triangles that use a vertex twice are ignored. Cost: linear time.
[[nodiscard]] std::vector<EdgeTally> tally_edges(const MeshView& mesh, const SiteTable& sites);

/// Connected components of triangles (connected through edges), in the order of their smallest triangles.
struct SurfaceComponents {
  std::uint32_t count = 0;
  /// Component of each triangle; no_component for triangles that use a vertex twice.
  std::vector<std::uint32_t> of_triangle;
  std::vector<std::uint8_t> is_closed;  ///< per component: every edge has exactly two triangles
  std::vector<std::uint8_t> is_shell;   ///< per component: closed and consistently oriented
};
/// Finds the connected components of the triangles of a mesh.
/// @param edges  the result of tally_edges() for the mesh.  Cost: linear time.
[[nodiscard]] SurfaceComponents find_components(const MeshView& mesh, const SiteTable& sites,
                                                std::span<const EdgeTally> edges);

}  // namespace blum::detail
