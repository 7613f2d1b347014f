// Blum: options that several commands have. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/command_line.hpp"
#include "common/summary.hpp"

namespace blum::cli {

/// An option with one value, which is read later.
void add_text_option(const Command& command, const char* name, std::optional<std::string>& value, const char* type,
                     const std::string& help);

/// --label, which may be given several times.
void add_label_option(const Command& command, std::vector<std::string>& labels, const char* help);

/// --weld, with or without a value: see prepare_weld().
void add_weld_option(const Command& command, std::optional<std::string>& weld,
                     const char* help = "Mesh: merge equal vertices, or those within TOL (default for STL: equal)");

/// The same where the file of an axis may tell.
constexpr const char* weld_of_axis_help = "Mesh: merge equal vertices, or those within TOL (default: as AXIS tells)";

void add_threads_option(const Command& command, std::optional<std::string>& threads);
void add_device_option(const Command& command, std::optional<std::string>& device);

/// --json and --quiet.
void add_report_options(const Command& command, ReportOptions& report,
                        const char* json_help = "Write a summary as JSON; - is standard output");

}  // namespace blum::cli
