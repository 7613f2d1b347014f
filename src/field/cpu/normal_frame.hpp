// Blum: the coordinates in which fields are computed. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "blum/geometry/triangle_mesh.hpp"
#include "blum/grid/grid_spec.hpp"
#include "field/kernels/normal_frame.hpp"

namespace blum::cpu {

using kernels::NormalFrame;

/// @param named  the vertices that the mesh names.
/// @throws InvalidGrid when the common box is so large that float32 distances would overflow.
[[nodiscard]] NormalFrame make_normal_frame(const MeshView& mesh, std::span<const std::uint32_t> named,
                                            const GridSpec& grid);

}  // namespace blum::cpu
