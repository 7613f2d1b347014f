// Blum: close pairs of primitives, culled by Voronoi diagrams. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "blum/core/context.hpp"
#include "blum/proximity/scene.hpp"
#include "proximity/scene_pairs.hpp"

namespace blum::detail {

/// Does the same as closest_pair(). Second-order distances of the cells bound the distance of the two objects, and
/// select the pairs that may be that close.
[[nodiscard]] std::optional<PrimitivePair> closest_pair_by_cells(const ObjectPair& pair, std::size_t objects,
                                                                 double cell_size, double max_distance,
                                                                 const Context& context, ProximityReport& report);

/// Does the same as closest_of_each().
void closest_of_each_by_cells(std::span<const ObjectPair> pairs, std::size_t objects, double cell_size,
                              double max_distance, const Context& context, ProximityPairs& out);

/// Does the same as near_pairs(), without neighbours.
void near_pairs_by_cells(std::span<const ObjectPair> pairs, std::size_t objects, double cell_size, double distance,
                         const Context& context, ProximityPairs& out);

}  // namespace blum::detail
