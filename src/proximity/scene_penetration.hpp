// Blum: how deep the objects of a scene lie in each other. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "blum/proximity/penetration.hpp"
#include "blum/proximity/scene.hpp"
#include "proximity/scene_object.hpp"

namespace blum::detail {

/// See ProximityScene::penetration().
[[nodiscard]] Penetrations penetrations(ObjectId first, const SceneObject& a, ObjectId second, const SceneObject& b,
                                        const PenetrationOptions& options, const Context& context);

}  // namespace blum::detail
