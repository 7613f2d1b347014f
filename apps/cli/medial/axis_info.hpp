// Blum: what a file of a medial axis holds. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "common/summary.hpp"

namespace blum::cli {

/// Reads an axis, and reports its counts, its topology and what its file tells of where it came from; writes its graph
/// where one is asked for.
/// @throws FileError, FormatError; InvalidOption where the file lacks what the graph needs.
void report_axis(const std::filesystem::path& path, const std::optional<std::filesystem::path>& graph,
                 const ReportOptions& options);

}  // namespace blum::cli
