// Blum: what surface maps look like in the viewer. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "view/scene_blob.hpp"

namespace blum::cli {

/// Reads a surface map and adds what the viewer needs of it: all of it but what is known of vertices and means.
/// @throws FileError (for more than browsers can hold, too), FormatError.
[[nodiscard]] Json map_item(SceneBlob& blob, const std::filesystem::path& path);

}  // namespace blum::cli
