// Blum: writers of surface maps, one for each format. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "blum/io/surface_map_io.hpp"

namespace blum::surface_map_files {

/// Content of a file. check() has verified that its parts fit together.
struct Request {
  const std::filesystem::path& path;
  const MeshView& mesh;
  const SurfaceMap& map;
  const FileMetadata& metadata;  ///< the given metadata, and those of the map
  const SurfaceMapWriteOptions& options;
  const Context& context;
};

/// Key in metadata for SurfaceAtlas::is_separate.
inline constexpr std::string_view separate_key = "separate_charts";

/// @throws InvalidMesh if the map lacks required parts.
void check(const SurfaceMap& map);

/// Returns a title for the map, for example "distance (mm)".
[[nodiscard]] std::string title_of(const SurfaceMap& map, const std::string& units);

void write_npz(const Request& request);
void write_picture(const Request& request);
void write_glb(const Request& request);
void write_columns(const Request& request);

}  // namespace blum::surface_map_files
