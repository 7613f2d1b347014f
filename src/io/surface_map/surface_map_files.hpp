// Blum: writers of surface maps, one for each format. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "blum/io/surface_map_io.hpp"

namespace blum::surface_map_files {

/// Content of a file. Its parts fit together, because check() was called.
struct Request {
  const std::filesystem::path& path;
  const MeshView& mesh;
  const SurfaceMap& map;
  const FileMetadata& metadata;  ///< given metadata and those of the map
  const SurfaceMapWriteOptions& options;
  const Context& context;
};

/// Key of SurfaceAtlas::is_separate in metadata.
inline constexpr std::string_view separate_key = "separate_charts";

/// @throws InvalidMesh if a map lacks parts.
void check(const SurfaceMap& map);

/// Returns a title, for example "distance (mm)".
[[nodiscard]] std::string title_of(const SurfaceMap& map, const std::string& units);

void write_npz(const Request& request);
void write_picture(const Request& request);
void write_glb(const Request& request);
void write_columns(const Request& request);

}  // namespace blum::surface_map_files
