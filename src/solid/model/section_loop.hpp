// Blum: closed curves in which a plane cuts a surface. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "solid/model/surface_mesh.hpp"

namespace blum::detail {

/// Returns true if the solid lies outside a closed curve, near the curve. In this curve, the plane across an axis cuts
/// the solid's surface. Exact.
/// @param edges  of the mesh, that the curve passes; at least one.
[[nodiscard]] bool is_around_hole(const SurfaceMesh& mesh, std::span<const std::uint32_t> edges, std::size_t across,
                                  double plane);

}  // namespace blum::detail
