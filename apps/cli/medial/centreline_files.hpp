// Blum: files of centrelines. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "blum/medial_axis/centreline.hpp"
#include "common/described.hpp"

namespace blum::cli {

/// Extensions with dots.
[[nodiscard]] std::vector<std::string> centreline_extensions();

/// By the extension: .json holds all; .csv a row for each branch; .swc a tree of points for each component, where loops
/// are cut; the formats of complexes polylines with radii. A file appears when it is complete.
/// @param head  of the JSON, before the labels. @throws FileError, Cancelled.
void write_centrelines(const std::filesystem::path& path, const Centrelines& lines, const Json& head,
                       const Context& context);

}  // namespace blum::cli
