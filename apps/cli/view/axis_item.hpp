// Blum: medial axes in scenes of the viewer. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "blum/core/context.hpp"
#include "medial/medial_report.hpp"
#include "view/scene_blob.hpp"

namespace blum::cli {

/// Adds a medial axis, an extended one, walls or curves to a scene. @throws Cancelled.
[[nodiscard]] Json axis_item(SceneBlob& blob, const ShownAxis& read, const Context& context);

}  // namespace blum::cli
