// Blum: the least translation that separates two objects of a scene. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "blum/proximity/least_translation.hpp"
#include "proximity/scene_pairs.hpp"

namespace blum::detail {

/// Returns the bounds that ProximityScene::least_translation() returns.
/// @throws as ProximityScene::least_translation().
[[nodiscard]] LeastTranslation least_translation(const TwoObjects& two, const TranslationOptions& options,
                                                 const Context& context);

}  // namespace blum::detail
