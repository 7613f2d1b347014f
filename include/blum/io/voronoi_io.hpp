// Blum: what files of Voronoi diagrams say. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "blum/io/file_metadata.hpp"
#include "blum/voronoi/voronoi_complex.hpp"

namespace blum {

/// What write_complex() is told of a Voronoi diagram: `content`, `blum_version`, `certified`, and then
/// `hausdorff_bound` (mesh units), else `failing_cubes`, how many do not pass.
/// @param hausdorff_bound  of VoronoiReport; nullopt where the complex is not certified.
[[nodiscard]] FileMetadata voronoi_metadata(VoronoiPart part, std::optional<double> hausdorff_bound,
                                            std::size_t failing_cubes, std::string_view version);

}  // namespace blum
