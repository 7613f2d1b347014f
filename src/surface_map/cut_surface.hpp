// Blum: division of triangles into small triangles. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/vec3.hpp"
#include "blum/geometry/triangle_mesh.hpp"

namespace blum::surface {

struct CutPiece {
  std::array<Vec3d, 3> corners{};
  double area = 0;
};

/// Cuts the triangles of a mesh that have an area into smaller triangles. Needles are cut only across their lengths.
/// @param mesh   with a largest coordinate of about 1.
/// @param count  approximate number of pieces, at least 1. Triangles that are small already stay whole.
/// @param size   pieces need not be smaller than this.
/// @return       the same for any number of threads.
/// @throws Cancelled.
[[nodiscard]] std::vector<CutPiece> cut_surface(const MeshView& mesh, double count, double size,
                                                const Context& context);

}  // namespace blum::surface
