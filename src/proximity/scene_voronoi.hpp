// Blum: close pairs of primitives, culled by Voronoi diagrams. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "blum/core/context.hpp"
#include "blum/proximity/scene.hpp"
#include "proximity/scene_pairs.hpp"

namespace blum::detail {

/// Returns the result of closest_pair(). Distances from the middles of cells bound the distance of the two objects, and
/// select the pairs of primitives that may be that close.
[[nodiscard]] std::optional<PrimitivePair> closest_pair_by_cells(const ObjectPair& pair, std::size_t objects,
                                                                 double cell_size, double max_distance,
                                                                 const Context& context, ProximityReport& report);

/// Returns the result of closest_of_each(), computed with cells instead of hierarchies.
void closest_of_each_by_cells(std::span<const ObjectPair> pairs, std::size_t objects, double cell_size,
                              double max_distance, const Context& context, ProximityPairs& out);

/// Returns the result of near_pairs() with Neighbours::left_out, computed with cells instead of hierarchies.
void near_pairs_by_cells(std::span<const ObjectPair> pairs, std::size_t objects, double cell_size, double distance,
                         const Context& context, ProximityPairs& out);

}  // namespace blum::detail
