// Blum: depths of objects of a scene in each other. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/phase_timer.hpp"
#include "blum/proximity/penetration.hpp"
#include "proximity/scene_pairs.hpp"

namespace blum::detail {

/// Returns true if two objects certainly do not overlap, because their boxes do not overlap.
[[nodiscard]] bool are_apart(const TwoObjects& two);

/// Returns, for each pair, the parts of its overlap, as ProximityScene::penetration() does. Each object is converted to
/// a solid once.
/// @param phases  receives the time spent.
[[nodiscard]] std::vector<std::vector<Penetration>> penetrations(std::span<const TwoObjects> pairs,
                                                                 const PenetrationOptions& options,
                                                                 const Context& context,
                                                                 std::vector<PhaseTime>& phases);

}  // namespace blum::detail
