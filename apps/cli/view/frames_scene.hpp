// Blum: meshes as the frames of a moving scene, for the viewer. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "blum/core/context.hpp"
#include "view/view_scene.hpp"

namespace blum::cli {

/// Reads meshes as the frames of one scene, in their order: one item. Triangles are there once for frames that follow
/// each other and have the same.
/// @param pairs  a file of what is close in each, see read_frame_pairs().
/// @param weld  of meshes.
/// @throws FileError where one of the files cannot be read, has no triangle, or where all together are too large to
/// show; FormatError for pairs; Cancelled.
[[nodiscard]] Scene make_frames_scene(const std::vector<std::filesystem::path>& frames,
                                      const std::optional<std::filesystem::path>& pairs, std::optional<double> weld,
                                      bool compresses, const Context& context);

}  // namespace blum::cli
