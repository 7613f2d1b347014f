// Blum: generalized winding numbers of many points. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// Returns the generalized winding number (see WindingNumber) of a mesh's triangles at any points, threaded.
///
/// @param mesh       must pass validate(mesh). Segments and points have no winding number and are ignored.
/// @param points     finite.
/// @param max_error  > 0. Values are off by at most max_error or 2e-11, whichever is larger. Off the surface of a
///                   closed mesh they are exact whole numbers. At points of the surface itself, any value of the jump
///                   may be returned.
/// @return           one per point, in their order; the same for any number of threads.
/// @throws InvalidMesh.
/// @throws InvalidOption, also for a point that is not finite; the message names its index.
/// @throws Cancelled.
/// Cost: O(n log n) for n triangles, then a time per point and core. If the mesh is closed or has at most 2,048
/// boundary edges, this is 0.2 to 1 us. Each of these edges adds 3 ns. For soups it is that of
/// WindingNumber::estimate() or 3 ns per triangle, whichever is less.
[[nodiscard]] std::vector<double> winding_numbers(const MeshView& mesh, std::span<const Vec3d> points,
                                                  double max_error = 1e-6, const Context& context = {});

}  // namespace blum
