// Blum: the texts of files of graphs. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "blum/io/medial_io.hpp"
#include "blum/medial_axis/axis_graph.hpp"

namespace blum::graph_files {

/// A named value of a graph, a node or an edge.
using Attribute = std::pair<std::string, std::variant<std::int64_t, double, bool, std::string>>;
using Attributes = std::vector<Attribute>;

/// What graphs tell of the axis that they are of; what is not known is left out.
[[nodiscard]] Attributes told(const MedialMetadata& metadata);

/// Each the whole content of a file.
[[nodiscard]] std::string json_text(const AxisGraph& graph, const MedialMetadata& metadata);
[[nodiscard]] std::string graphml_text(const AxisGraph& graph, const MedialMetadata& metadata);

}  // namespace blum::graph_files
