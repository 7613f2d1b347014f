// Blum: meshes and images as solids. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/core/error.hpp"
#include "blum/field/distance_transform.hpp"
#include "common/files.hpp"
#include "common/summary.hpp"
#include "common/weld_facts.hpp"

namespace blum::cli {

/// Mesh or image that bounds a solid.
struct SolidInput {
  InputKind kind = InputKind::mesh;
  MeshFile mesh;
  VoxelImage image;
  std::vector<Warning> image_warnings;
  std::optional<WeldFacts> weld;  ///< set if vertices were welded within a tolerance above 0
  Json json;
  TextTable table;
};

/// @param weld  welding tolerance of meshes, in mesh units; 0 welds only vertices at equal positions.
/// @param labels  labels that will be selected in an image. If there are any, labels that are nearly whole are rounded.
/// @throws FileError if the file is a field, cannot be read, or is an image that contains only NaN; InvalidMesh,
/// InvalidImage.
[[nodiscard]] SolidInput load_solid(const std::filesystem::path& path, std::optional<double> weld,
                                    std::span<const std::int64_t> labels = {});

/// Returns the result of input_kind(). A signal ends the program at once, because a pipe may wait for its writer.
/// @throws as input_kind().
[[nodiscard]] InputKind kind_of_input(const std::filesystem::path& path);

/// Returns the warnings about an input. Images: those of the file. Meshes: a weld tolerance changed the number of
/// components or the Euler number.
[[nodiscard]] std::vector<Warning> warnings_of(const SolidInput& input);

/// Returns the diagonal of the box of a solid: of the mesh, or of the selected voxels of the image.
[[nodiscard]] double size_of(const SolidInput& input, const LabelSelection& selection, const Context& context);

/// Returns the result of make(), and adds the file's name to its errors. @throws InvalidMesh.
template <class Make>
[[nodiscard]] auto of_file(const std::filesystem::path& path, const Make& make) {
  try {
    return make();
  } catch (const InvalidMesh& error) {
    throw InvalidMesh("'" + path.string() + "': " + error.what());
  }
}

/// Voxels that --label and --threshold select. If neither is given, all voxels with a value other than 0 are selected.
struct Selections {
  std::vector<std::int64_t> labels;
  std::optional<double> threshold;
  [[nodiscard]] std::vector<LabelSelection> all() const;
};

/// Reads the values of --label and --threshold. @throws UsageError, InvalidOption.
[[nodiscard]] Selections parse_selections(const std::vector<std::string>& labels,
                                          const std::optional<std::string>& threshold);

}  // namespace blum::cli
