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

/// A mesh or an image whose solid is asked for.
struct SolidInput {
  InputKind kind = InputKind::mesh;
  MeshFile mesh;
  VoxelImage image;
  std::optional<WeldFacts> weld;  ///< where vertices within a tolerance above 0 were joined
  Json json;
  TextTable table;
};

/// @param weld  for meshes.
/// @throws FileError for fields and for what cannot be read; InvalidMesh, InvalidImage.
[[nodiscard]] SolidInput load_solid(const std::filesystem::path& path, std::optional<double> weld);

/// What there is to say of an input as it was read: how many vertices were joined.
[[nodiscard]] std::vector<Warning> warnings_of(const SolidInput& input);

/// What make() makes of a file; of a mesh that it does not take, the error names the file. @throws InvalidMesh.
template <class Make>
[[nodiscard]] auto of_file(const std::filesystem::path& path, const Make& make) {
  try {
    return make();
  } catch (const InvalidMesh& error) {
    throw InvalidMesh("'" + path.string() + "': " + error.what());
  }
}

/// What --label and --threshold select; all that is not 0 where neither is given. Checked against the kind of the
/// input.
struct Selections {
  std::vector<std::int64_t> labels;
  std::optional<double> threshold;
  [[nodiscard]] std::vector<LabelSelection> all() const;
};

/// The values of --label and --threshold. @throws UsageError, InvalidOption.
[[nodiscard]] Selections parse_selections(const std::vector<std::string>& labels,
                                          const std::optional<std::string>& threshold);

}  // namespace blum::cli
