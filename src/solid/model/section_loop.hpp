// Blum: closed curves in which a plane cuts a surface. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "solid/model/surface_mesh.hpp"

namespace blum::detail {

/// Whether the solid lies outside of a closed curve in which the plane across an axis cuts its surface, near the curve.
/// Exact. @param edges  of the mesh, that the curve passes; at least one.
[[nodiscard]] bool is_around_hole(const SurfaceMesh& mesh, std::span<const std::uint32_t> edges, std::size_t across,
                                  double plane);

}  // namespace blum::detail
