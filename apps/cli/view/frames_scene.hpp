// Blum: meshes as the frames of a moving scene, for the viewer. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "blum/core/context.hpp"
#include "view/view_scene.hpp"

namespace blum::cli {

/// Reads meshes as the frames of one scene, in their order. They become one item. Consecutive frames with the same
/// triangles share them.
/// @param pairs  a file of close pairs, see read_frame_pairs().
/// @param weld  welding tolerance of the meshes; 0 merges equal vertices.
/// @throws FileError if a file cannot be read or has no triangle, or if all together are too large to show; FormatError
/// for pairs; Cancelled.
[[nodiscard]] Scene make_frames_scene(const std::vector<std::filesystem::path>& frames,
                                      const std::optional<std::filesystem::path>& pairs, std::optional<double> weld,
                                      bool compresses, const Context& context);

}  // namespace blum::cli
