// Blum: the texts of files of graphs. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "blum/axis/axis_graph.hpp"
#include "blum/io/medial_io.hpp"
#include "io/graph_ml.hpp"

namespace blum::graph_files {

/// What graphs tell of the axis that they are of; what is not known is left out.
[[nodiscard]] Attributes told(const MedialMetadata& metadata);

/// Each the whole content of a file.
[[nodiscard]] std::string json_text(const AxisGraph& graph, const MedialMetadata& metadata);
[[nodiscard]] std::string graphml_text(const AxisGraph& graph, const MedialMetadata& metadata);

}  // namespace blum::graph_files
