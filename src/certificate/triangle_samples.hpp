// Blum: points spread over a mesh, for the verifier. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "blum/core/context.hpp"
#include "blum/geometry/triangle_mesh.hpp"
#include "certificate/solid_oracle.hpp"

namespace blum::verifier {

/// Points of triangles, and all their corners, as SolidOracle::samples() gives them.
/// @param groups  of each triangle; those of no_group are left out. Empty: all are taken.
/// @throws Cancelled.
[[nodiscard]] Samples samples_of_triangles(const MeshView& mesh, std::span<const std::uint32_t> groups, double step,
                                           const Context& context);

}  // namespace blum::verifier
