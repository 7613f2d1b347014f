// Blum: surface maps in scenes of the viewer. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "view/scene_blob.hpp"

namespace blum::cli {

/// Reads a surface map and adds it to a scene. The map's values at vertices and its means are left out.
/// @throws FileError, also if the map is too large for browsers; FormatError.
[[nodiscard]] Json map_item(SceneBlob& blob, const std::filesystem::path& path);

}  // namespace blum::cli
