// Blum: generalized winding numbers of many points. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Returns the generalized winding numbers (see WindingNumber) of a mesh's triangles at any points, computed with
/// threads.
///
/// @param mesh       must pass validate(mesh). Segments and points of the mesh have no winding number and are ignored.
/// @param points     finite.
/// @param max_error  > 0. The error of a value is at most max_error or 2e-11, whichever is larger. If the mesh is
///                   closed, the values at points that are not on the surface are exact whole numbers. At a point of
///                   the surface, the winding number jumps, and any value between the values on the two sides may be
///                   returned.
/// @return           one value per point, in the order of the points. The values are the same for any number of
///                   threads.
/// @throws InvalidMesh.
/// @throws InvalidOption, also for a point that is not finite. The message contains the index of the point.
/// @throws Cancelled.
/// Cost: O(n log n) for n triangles, plus one query per point. The following times of a query are for one core. If the
/// mesh has at most 2,048 boundary edges, a point takes 0.2 to 1 us, plus 3 ns per boundary edge. For other meshes, a
/// point takes the time of WindingNumber::estimate() or 3 ns per triangle, whichever is less.
[[nodiscard]] std::vector<double> winding_numbers(const MeshView& mesh, std::span<const Vec3d> points,
                                                  double max_error = 1e-6, const Context& context = {});

}  // namespace blum
