// Blum: meshes and images as solids. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/field/distance_transform.hpp"
#include "common/files.hpp"
#include "common/summary.hpp"
#include "common/weld_facts.hpp"

namespace blum::cli {

/// A mesh or an image that bounds a solid.
struct SolidInput {
  InputKind kind = InputKind::mesh;
  MeshFile mesh;
  VoxelImage image;
  std::optional<WeldFacts> weld;  ///< if vertices within a tolerance above 0 were merged
  Json json;
  TextTable table;
};

/// @param weld  welding tolerance of meshes, in mesh units; 0 merges equal vertices.
/// @throws FileError for fields, unreadable files and images with only NaN; InvalidMesh, InvalidImage.
[[nodiscard]] SolidInput load_solid(const std::filesystem::path& path, std::optional<double> weld);

/// Returns the warnings of an input: a weld tolerance that changed components or Euler number.
[[nodiscard]] std::vector<Warning> warnings_of(const SolidInput& input);

/// Returns the result of make(), and adds the file's name to its errors. @throws InvalidMesh.
template <class Make>
[[nodiscard]] auto of_file(const std::filesystem::path& path, const Make& make) {
  try {
    return make();
  } catch (const InvalidMesh& error) {
    throw InvalidMesh("'" + path.string() + "': " + error.what());
  }
}

/// The voxels that --label and --threshold select. Without either, all voxels that are not 0.
struct Selections {
  std::vector<std::int64_t> labels;
  std::optional<double> threshold;
  [[nodiscard]] std::vector<LabelSelection> all() const;
};

/// Reads the values of --label and --threshold. @throws UsageError, InvalidOption.
[[nodiscard]] Selections parse_selections(const std::vector<std::string>& labels,
                                          const std::optional<std::string>& threshold);

}  // namespace blum::cli
