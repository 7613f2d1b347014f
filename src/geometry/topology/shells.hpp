// Blum: components of a surface, and the nesting of its closed ones. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
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
[[nodiscard]] std::vector<EdgeTally> tally_edges(const MeshView& mesh, const SiteTable& sites);

/// Connected components of triangles (connected through edges), in the order of their smallest triangles.
struct SurfaceComponents {
  std::uint32_t count = 0;
  /// Component of each triangle; no_component for triangles that use a vertex twice.
  std::vector<std::uint32_t> of_triangle;
  std::vector<std::uint8_t> is_closed;  ///< per component: every edge has exactly two triangles
  std::vector<std::uint8_t> is_shell;   ///< per component: closed and consistently oriented
};
[[nodiscard]] SurfaceComponents find_components(const MeshView& mesh, const SiteTable& sites,
                                                std::span<const EdgeTally> edges);

/// Shells (closed, consistently oriented components), and their triangles.
struct ShellSet {
  std::vector<Shell> shells;
  std::vector<std::uint32_t> of_triangle;  ///< shell of each triangle, or no_component
};

/// Finds the shells, but not their Euler characteristics and genera. Cost: linear time. In addition, for each shell,
/// the triangles above one of its vertices that belong to shells around that vertex.
[[nodiscard]] ShellSet find_shells(const MeshView& mesh, const SurfaceComponents& components, const Context& context);

/// Sets the depth and parent of each shell. They follow from the winding numbers of the other shells around one of its
/// points. These are computed from the triangles that a ray from the point crosses. The point is a vertex that lies on
/// no other shell, or else the middle of a triangle that lies on no other shell. If all vertices and middles lie on
/// other shells, many points slightly inside the shell are used. The shell then lies in those shells that surround all
/// of these points. If shells coincide so often that a bounded number of comparisons finds no such point, a vertex that
/// lies on other shells decides.
/// @param set  must have signed volumes; their signs determine the inner side of each shell.
/// @return  number of comparisons of a triangle with a point.
std::size_t nest_shells(const MeshView& mesh, ShellSet& set, const Context& context);

}  // namespace blum::detail
