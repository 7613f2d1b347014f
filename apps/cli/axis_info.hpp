// Blum: what a file of a medial axis holds. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "summary.hpp"

namespace blum::cli {

/// Reads an axis, and reports its counts, its topology and what its file tells of where it came from.
/// @throws FileError, FormatError.
void report_axis(const std::filesystem::path& path, const ReportOptions& options);

}  // namespace blum::cli
