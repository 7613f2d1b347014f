// Blum: how deep the objects of a scene lie in each other. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/proximity/penetration.hpp"
#include "proximity/scene_pairs.hpp"

namespace blum::detail {

/// Whether the boxes of two objects show that they have nothing in common.
[[nodiscard]] bool are_apart(const TwoObjects& two);

/// See ProximityScene::penetration(): the parts of each of some pairs. What makes an object a solid is looked at once.
/// @param phases  is told how long that took.
[[nodiscard]] std::vector<std::vector<Penetration>> penetrations(std::span<const TwoObjects> pairs,
                                                                 const PenetrationOptions& options,
                                                                 const Context& context,
                                                                 std::vector<PhaseTime>& phases);

}  // namespace blum::detail
