// Blum: medial axes in scenes of the viewer. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "blum/core/context.hpp"
#include "view/scene_blob.hpp"

namespace blum::cli {

/// Reads a medial axis and adds it to a scene. @throws FileError, FormatError, Cancelled.
[[nodiscard]] Json axis_item(SceneBlob& blob, const std::filesystem::path& path, const Context& context);

}  // namespace blum::cli
