// Blum: files and summaries of extended medial axes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "blum/axis/extend_axis.hpp"
#include "common/summary.hpp"

namespace blum::cli {

/// Adds --extend and --extend-length.
void add_extend_options(const Command& command, std::optional<std::string>& extend, std::optional<std::string>& length);

/// Returns the value of --extend. @throws UsageError if write_extended() cannot write files with its extension.
[[nodiscard]] std::optional<std::filesystem::path> parse_extend(const std::optional<std::string>& text);
/// @throws UsageError if a length is given without --extend, or is not above 0.
[[nodiscard]] ExtendOptions parse_extend_length(const std::optional<std::string>& text, bool has_extend);

/// Returns a text like "area from 4671 to 5000 by 13 triangles; of 12 rim vertices 10 reach the surface".
[[nodiscard]] std::string extended_text(const ExtendReport& report);
/// Returns the report as JSON. @param file name of the extended file.
[[nodiscard]] Json extended_json(const ExtendReport& report, const std::filesystem::path& file);

/// Returns the name of a file that belongs to one of several axes. If the axis OUT.vtp is written as OUT-theta20.vtp,
/// it is FILE-theta20.json for FILE.json.
[[nodiscard]] std::filesystem::path beside_axis(const std::filesystem::path& file, const std::filesystem::path& output,
                                                const std::filesystem::path& name);

}  // namespace blum::cli
