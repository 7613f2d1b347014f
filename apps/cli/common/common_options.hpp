// Blum: options that several commands have. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/command_line.hpp"
#include "common/summary.hpp"

namespace blum::cli {

/// Adds an option with one value, which is stored as text and parsed later.
void add_text_option(const Command& command, const char* name, std::optional<std::string>& value, const char* type,
                     const std::string& help);

/// Adds --label, which may be repeated.
void add_label_option(const Command& command, std::vector<std::string>& labels, const char* help);

/// Adds --weld, whose value may be omitted; see prepare_weld().
void add_weld_option(const Command& command, std::optional<std::string>& weld,
                     const char* help =
                         "Mesh: merge equal vertices; with TOL, vertices at most TOL mesh units apart (default for "
                         "STL: merge equal vertices)");

/// Help of --weld for commands that read a medial axis. The axis's file may record the tolerance.
constexpr const char* weld_of_axis_help =
    "Mesh: merge equal vertices; with TOL, vertices at most TOL mesh units apart (default: as recorded in AXIS)";

void add_threads_option(const Command& command, std::optional<std::string>& threads);
void add_device_option(const Command& command, std::optional<std::string>& device);

/// Adds --json, --quiet and --verbose.
void add_report_options(const Command& command, ReportOptions& report,
                        const char* json_help = "Write a summary as JSON; - is standard output");

}  // namespace blum::cli
