// Blum: oriented boxes around triangles and around boxes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "geometry/bvh/oriented_block.hpp"

namespace blum {

/// A box around eight triangles that lies along their common plane as far as they have one: its last axis is at right
/// angles to it. Of these boxes and those along the coordinate axes the smaller one.
/// @param block   gets its normals.
/// @param bounds  gets the box along the coordinate axes.
[[nodiscard]] OrientedBox box_around(FlatTriangleBlock& block, Box3& bounds);

/// The same around boxes whose last axes are at right angles to the surface in them.
/// @param bounds  the box along the coordinate axes around what is in them.
[[nodiscard]] OrientedBox box_around(std::span<const OrientedBox> boxes, const Box3& bounds);

}  // namespace blum
