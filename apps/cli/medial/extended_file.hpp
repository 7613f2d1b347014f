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

/// Returns the value of --extend. @throws UsageError for an extension that write_extended() does not write.
[[nodiscard]] std::optional<std::filesystem::path> parse_extend(const std::optional<std::string>& text);
/// @throws UsageError for a length without --extend, or one that is not above 0.
[[nodiscard]] ExtendOptions parse_extend_length(const std::optional<std::string>& text, bool has_extend);

/// Returns for example "area from 4671 to 5000 by 13 triangles; of 12 rim vertices 10 reach the surface".
[[nodiscard]] std::string extended_text(const ExtendReport& report);
/// Returns the report as JSON. @param file  its name.
[[nodiscard]] Json extended_json(const ExtendReport& report, const std::filesystem::path& file);

/// Returns the name of a further file of an axis: FILE-theta20.json for FILE.json if OUT.vtp became OUT-theta20.vtp.
[[nodiscard]] std::filesystem::path beside_axis(const std::filesystem::path& file, const std::filesystem::path& output,
                                                const std::filesystem::path& name);

}  // namespace blum::cli
