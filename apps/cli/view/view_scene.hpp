// Blum: scenes of files for the viewer. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "blum/core/context.hpp"
#include "view/scene_blob.hpp"

namespace blum::cli {

/// Scene for the viewer, made from files. Each file is one item, in the given order.
struct Scene {
  Json header;  ///< items, colours, and the numbers that stand for roles
  SceneBlob blob;
  std::vector<std::string> problems;  ///< one message for each file that could not be read
};

/// Reads meshes, images, fields, medial axes and surface maps. If a file cannot be read, its item contains the error
/// message.
/// @param weld  welding tolerance of meshes; 0 welds only vertices at equal positions.
/// @throws Cancelled.
[[nodiscard]] Scene make_scene(const std::vector<std::filesystem::path>& files, std::optional<double> weld,
                               bool compresses, const Context& context);

}  // namespace blum::cli
