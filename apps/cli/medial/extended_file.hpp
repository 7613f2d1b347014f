// Blum: extended medial axes as the tool writes and sums them up. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "blum/axis/extend_axis.hpp"
#include "common/summary.hpp"

namespace blum::cli {

/// --extend and --extend-length.
void add_extend_options(const Command& command, std::optional<std::string>& extend, std::optional<std::string>& length);

/// The value of --extend. @throws UsageError for an extension that write_extended() does not take.
[[nodiscard]] std::optional<std::filesystem::path> parse_extend(const std::optional<std::string>& text);
/// @throws UsageError for a length without --extend, and for one that is not above 0.
[[nodiscard]] ExtendOptions parse_extend_length(const std::optional<std::string>& text, bool has_extend);

/// "from an area of 4,671 to 5,000: 13 triangles; ..."
[[nodiscard]] std::string extended_text(const ExtendReport& report);
/// The report. @param file  its name.
[[nodiscard]] Json extended_json(const ExtendReport& report, const std::filesystem::path& file);

/// Where a file goes that tells more of an axis: FILE-theta20.json for FILE.json where OUT.vtp became OUT-theta20.vtp.
[[nodiscard]] std::filesystem::path beside_axis(const std::filesystem::path& file, const std::filesystem::path& output,
                                                const std::filesystem::path& name);

}  // namespace blum::cli
