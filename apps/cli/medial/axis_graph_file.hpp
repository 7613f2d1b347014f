// Blum: graphs of medial axes as the tool writes and sums them up. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "blum/axis/axis_graph.hpp"
#include "blum/io/medial_io.hpp"
#include "common/summary.hpp"

namespace blum::cli {

/// --graph.
void add_graph_option(const Command& command, std::optional<std::string>& graph, const std::string& help);

/// The value of --graph. @throws UsageError for another extension than those of graphs.
[[nodiscard]] std::optional<std::filesystem::path> parse_graph(const std::optional<std::string>& text);

/// "13 sheets, 24 seams, 0 curves, 8 junctions; thinnest wall: sheet 3, 0.5 thick". A wall is a sheet of 1 % of the
/// area or more whose median separation angle is 150 degrees or more; its thickness is the low one
/// of its spread: walls of different thickness may be one sheet.
[[nodiscard]] std::string graph_text(const AxisGraph& graph);
/// The same numbers. @param file  its name.
[[nodiscard]] Json graph_json(const AxisGraph& graph, const std::filesystem::path& file);

}  // namespace blum::cli
