// Blum: directions that tell moving features apart. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/proximity/impact.hpp"

namespace blum::detail {

/// Whether for certain some of ten directions tells the first points from the rest: along it, the first are on one side
/// of the rest, by more than a distance, at both ends of the motion, and so all the time. The three axes are not among
/// the directions: boxes have looked along them.
/// @param first_count  1 for a vertex and a face, 2 for two edges.  @param distance  mesh units, >= 0.
[[nodiscard]] bool are_apart(const FourMovingPoints& points, std::size_t first_count, double distance);

}  // namespace blum::detail
