// Blum: the formats of surface maps, one by one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "blum/io/surface_map_io.hpp"

namespace blum::surface_map_files {

/// What a file gets. All fits together: check() was called.
struct Request {
  const std::filesystem::path& path;
  const MeshView& mesh;
  const SurfaceMap& map;
  const FileMetadata& metadata;  ///< all of them
  const SurfaceMapWriteOptions& options;
  const Context& context;
};

/// The key of SurfaceAtlas::is_separate in metadata.
inline constexpr std::string_view separate_key = "separate_charts";

/// @throws InvalidMesh where a map lacks parts.
void check(const SurfaceMap& map);

/// "distance (mm)".
[[nodiscard]] std::string title_of(const SurfaceMap& map, const std::string& units);

void write_npz(const Request& request);
void write_picture(const Request& request);
void write_glb(const Request& request);
void write_columns(const Request& request);

}  // namespace blum::surface_map_files
