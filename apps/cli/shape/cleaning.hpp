// Blum: what is told of cleaned meshes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "blum/solid/clean_mesh.hpp"
#include "common/summary.hpp"

namespace blum::cli {

/// Adds what was done to a table.
void add_cleaning(const CleanReport& done, double tolerance, TextTable& table);

/// The same as JSON.
[[nodiscard]] Json cleaning_json(const CleanReport& done, double tolerance);

/// Warns where a file that holds single precision does not hold a mesh as it was checked.
void add_rounding_warning(const std::filesystem::path& file, const TriangleMesh& mesh, std::vector<Warning>& warnings);

}  // namespace blum::cli
