// Blum: files of graphs of medial axes (JSON, GraphML). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "blum/axis/axis_graph.hpp"
#include "blum/core/error.hpp"
#include "blum/io/medial_io.hpp"

namespace blum {

/// Writes the graph of a medial axis. The extension selects the format.
///
///   `.json`     Everything: an object with the members of AxisGraph and their members, by their names. Before them
///               come `content` ("graph of a medial axis") and the known metadata: `blum_version`, `source`, `theta`,
///               `lambda`, `spacing`, `deviation`, `label`, `threshold` and `smooth`.
///   `.graphml`  An undirected graph for programs such as networkx, Gephi, igraph and yEd. The attribute `element`
///               holds the kind of a node. Nodes are `sheet3` (by the sheet's number), `seam0`, `junction0`, `patch0`,
///               and `curve0` for closed curves. Edges `curve` join two junctions. Edges `incidence` join a sheet and
///               its seams, a seam and its junctions, or a sheet and the junctions on it. Edges `wall` join a sheet and
///               the patches of its sides. Their `share` is that of the pairs that name the patch. The other attributes
///               are the members that are numbers, words or truth values, by their names. Members of members have both
///               names (`thickness_median`), vectors _x, _y, _z. Metadata are attributes of the graph.
///
/// A file appears under its name only when it is complete.
/// @throws InvalidOption for another extension.
/// @throws FileError.
void write_graph(const std::filesystem::path& path, const AxisGraph& graph, const MedialMetadata& metadata = {});

}  // namespace blum
