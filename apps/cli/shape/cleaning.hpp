// Blum: reports on cleaned meshes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "blum/solid/clean_mesh.hpp"
#include "common/summary.hpp"

namespace blum::cli {

/// Adds the report of cleaning to a table.
/// @param size  of the mesh; see share_text().
void add_cleaning(const CleanReport& done, double tolerance, double size, TextTable& table);

/// Returns the report as JSON.
[[nodiscard]] Json cleaning_json(const CleanReport& done, double tolerance);

/// Adds a warning if the file's format has single precision (.stl), so that it rounds the vertices of the checked mesh.
void add_rounding_warning(const std::filesystem::path& file, const TriangleMesh& mesh, std::vector<Warning>& warnings);

}  // namespace blum::cli
