// Blum: files and summaries of graphs of medial axes. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "blum/axis/axis_graph.hpp"
#include "blum/io/medial_io.hpp"
#include "common/summary.hpp"

namespace blum::cli {

/// Adds --graph.
void add_graph_option(const Command& command, std::optional<std::string>& graph, const std::string& help);

/// Returns the value of --graph. @throws UsageError if its extension is not one for graphs.
[[nodiscard]] std::optional<std::filesystem::path> parse_graph(const std::optional<std::string>& text);

/// Returns a text like "13 sheets, 24 seams, 0 curves, 8 junctions; thinnest large wall: sheet 3, 0.5 thick".
/// A wall is the part of a sheet in which triangles have separation angles of at least 150 degrees at all corners.
/// Walls with less than 1 % of the axis's area are ignored, which the text says. The stated thickness is the low value
/// of the sheet's spread, because walls of different thickness may belong to one sheet.
[[nodiscard]] std::string graph_text(const AxisGraph& graph);
/// Returns the same facts as JSON. @param file name of the graph's file.
[[nodiscard]] Json graph_json(const AxisGraph& graph, const std::filesystem::path& file);

}  // namespace blum::cli
