// Blum: the check of path files by `blum verify`. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "blum/core/context.hpp"
#include "common/progress.hpp"
#include "common/summary.hpp"

namespace blum::cli {

/// Returns true if a file is read as a path: .json or .csv.
[[nodiscard]] bool is_path_file(const std::filesystem::path& path);

/// Checks the path in a file against its meshes, and reports the result.
struct PathCheck {
  std::filesystem::path path;
  /// Meshes: the body or bodies, then the obstacles. If empty, those that the path file names.
  std::vector<std::filesystem::path> meshes;
  std::optional<double> clearance;  ///< to be checked; if not given, the stated one, or 0
  ReportOptions report;
};
/// @throws NotCertified if the path is not certified.
void check_path(const PathCheck& check, Progress& progress, const Context& context);

}  // namespace blum::cli
