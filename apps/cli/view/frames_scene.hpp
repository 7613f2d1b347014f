// Blum: meshes as the frames of a moving scene, for the viewer. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "blum/core/context.hpp"
#include "view/view_scene.hpp"

namespace blum::cli {

/// Reads meshes as the frames of one scene, in the given order. The scene has one item. Consecutive frames with the
/// same triangles store them once.
/// @param pairs  file of close pairs; see read_frame_pairs().
/// @param weld  welding tolerance of the meshes; 0 welds only vertices at equal positions.
/// @throws FileError if a file cannot be read or has no triangle. FileError if all frames together are too large to be
/// shown. FormatError for errors in `pairs`; Cancelled.
[[nodiscard]] Scene make_frames_scene(const std::vector<std::filesystem::path>& frames,
                                      const std::optional<std::filesystem::path>& pairs, std::optional<double> weld,
                                      bool compresses, const Context& context);

}  // namespace blum::cli
