// Blum: scenes of files for the viewer. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "blum/core/context.hpp"
#include "view/scene_blob.hpp"

namespace blum::cli {

/// Files for the viewer: one item each, in their order.
struct Scene {
  Json header;  ///< items, colours, and the numbers of roles
  SceneBlob blob;
  std::vector<std::string> problems;  ///< messages of files that could not be read
};

/// Reads meshes, images, fields, medial axes and surface maps. A file that cannot be read becomes an item with its
/// message.
/// @param weld  welding tolerance of meshes; 0 merges equal vertices.
/// @throws Cancelled.
[[nodiscard]] Scene make_scene(const std::vector<std::filesystem::path>& files, std::optional<double> weld,
                               bool compresses, const Context& context);

}  // namespace blum::cli
