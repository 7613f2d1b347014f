// Blum: report on a file of a medial axis. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "common/summary.hpp"

namespace blum::cli {

/// Reads an axis. Reports its counts, its topology and its recorded origin. If `graph` is set, also writes its graph to
/// that file.
/// @throws FileError, FormatError; InvalidOption if the file lacks columns that the graph needs.
void report_axis(const std::filesystem::path& path, const std::optional<std::filesystem::path>& graph,
                 const ReportOptions& options);

}  // namespace blum::cli
