// Blum: summaries of input files. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "blum/core/context.hpp"
#include "blum/geometry/sites.hpp"
#include "blum/geometry/topology.hpp"
#include "blum/grid/voxel_image.hpp"
#include "blum/io/image_io.hpp"
#include "blum/io/mesh_io.hpp"
#include "common/summary.hpp"

namespace blum::cli {

/// Returns the file, format and counts of a mesh as JSON.
[[nodiscard]] Json file_json(const std::filesystem::path& path, const MeshFile& file);
[[nodiscard]] std::string file_text(const MeshFile& file);

/// Returns true if the mesh lost all its triangles by welding. The next function returns the text of the warning.
[[nodiscard]] bool is_welded_away(const MeshFile& file);
[[nodiscard]] std::string welded_away_text(const MeshFile& file);

/// Returns the result of file_json(), and properties of the mesh's surface that are cheap to compute.
[[nodiscard]] Json mesh_json(const std::filesystem::path& path, const MeshFile& file, const SiteTable& sites,
                             const Orientation& facts);
[[nodiscard]] TextTable mesh_table(const std::filesystem::path& path, const MeshFile& file, const SiteTable& sites,
                                   const Orientation& facts);

/// Returns the name of a format; "unknown" if there is none.
[[nodiscard]] std::string format_name(const std::optional<ImageFormat>& format);
/// Returns the file, format, value type and grid of an image as JSON.
[[nodiscard]] Json image_json(const std::filesystem::path& path, const VoxelImage& image,
                              const std::optional<ImageFormat>& format);
[[nodiscard]] TextTable image_table(const std::filesystem::path& path, const VoxelImage& image,
                                    const std::optional<ImageFormat>& format);
/// Rounds labels that are nearly whole numbers, and adds the warning about it.
/// @param labels  labels that are asked for; empty: all. @throws InvalidImage as rounded_labels().
void round_labels(ImageFile& file, std::span<const std::int64_t> labels, const Context& context = {});
/// Returns true if every voxel is NaN.
[[nodiscard]] bool has_only_nan(const VoxelImage& image);
/// Returns the name of the value type: "uint8", "float32" and so on.
[[nodiscard]] std::string type_name(const VoxelImage::Values& values);

}  // namespace blum::cli
