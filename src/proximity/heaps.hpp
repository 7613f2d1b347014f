// Blum: objects with so many primitives in one place that all pairs of them cannot be looked at.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "proximity/scene_pairs.hpp"

namespace blum::detail {

/// Says at once what a query would find after a minute.
/// @param objects  an object with itself.
/// @throws InvalidMesh where so many primitives share a vertex that they are more than most_candidates pairs.
void check_neighbours(const ObjectPair& objects);

/// @throws OutOfMemory where more than most_close_pairs pairs of equal triangles collide.
void check_equal_triangles(const ObjectPair& objects);

}  // namespace blum::detail
