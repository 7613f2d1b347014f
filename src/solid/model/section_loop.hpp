// Blum: closed curves in which a plane cuts a surface. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "solid/model/surface_mesh.hpp"

namespace blum::detail {

/// Returns true if, near a closed curve, the solid lies outside the curve. The curve is a section of the solid's
/// surface with a plane across an axis. The test is exact.
/// @param edges  the edges of the mesh at which the curve passes from triangle to triangle; at least one.
[[nodiscard]] bool is_around_hole(const SurfaceMesh& mesh, std::span<const std::uint32_t> edges, std::size_t across,
                                  double plane);

}  // namespace blum::detail
