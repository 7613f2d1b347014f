// Blum: generalized winding numbers of many points. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum {

/// The generalized winding number (see WindingNumber) of a mesh's triangles at any points, threaded.
///
/// @param mesh       must pass validate(mesh). Segments and points have no winding number and are left out.
/// @param points     finite.
/// @param max_error  > 0; values are off by no more, or than 2e-11 where it is less. Off the surface of a closed mesh
///                   they are whole numbers, exactly. At points of the surface itself any value of the jump may come.
/// @return           one per point, in their order; the same for any number of threads.
/// @throws InvalidMesh; InvalidOption, also for a point that is not finite (named by its index); Cancelled.
/// Cost: O(n log n) for n triangles; then, of a closed mesh or one with no more than 2,048 edges on its boundary, some
/// 0.2 to 1 us per point and core and 3 ns for each of these edges; of soups as WindingNumber::estimate() or, where
/// that is less, 3 ns per triangle.
[[nodiscard]] std::vector<double> winding_numbers(const MeshView& mesh, std::span<const Vec3d> points,
                                                  double max_error = 1e-6, const Context& context = {});

}  // namespace blum
