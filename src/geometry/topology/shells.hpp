// Blum: the closed components of a surface, and their nesting. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/geometry/triangle_components.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::detail {

/// Shells (closed, consistently oriented components), and their triangles.
struct ShellSet {
  std::vector<Shell> shells;
  std::vector<std::uint32_t> of_triangle;  ///< shell of each triangle, or no_component
};

/// Finds the shells, but not their Euler characteristics and genera. Cost: linear time. In addition, for each shell,
/// the triangles above one of its vertices that belong to shells around that vertex.
[[nodiscard]] ShellSet find_shells(const MeshView& mesh, const SurfaceComponents& components, const Context& context);

/// Sets the depth and parent of each shell. Depth and parent follow from the winding numbers of the other shells around
/// one point of the shell. A ray from the point crosses triangles, from which the winding numbers are computed. The
/// point is a vertex that lies on no other shell, or else the middle of a triangle that lies on no other shell. If all
/// vertices and middles lie on other shells, many points slightly inside the shell are used. The shell then lies in
/// those shells that surround all of these points. If shells coincide so often that a bounded number of comparisons
/// finds no such point, a vertex that lies on other shells decides.
/// @param set  must have signed volumes; their signs determine the inner side of each shell.
/// @return  number of comparisons of a triangle with a point.
std::size_t nest_shells(const MeshView& mesh, ShellSet& set, const Context& context);

}  // namespace blum::detail
