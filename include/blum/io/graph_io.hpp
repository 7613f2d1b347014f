// Blum: files of graphs of medial axes (JSON, GraphML). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "blum/axis/axis_graph.hpp"
#include "blum/core/error.hpp"
#include "blum/io/medial_io.hpp"

namespace blum {

/// Writes the graph of a medial axis; the format goes by the extension.
///
///   .json     all of it: an object with the members of AxisGraph and what they consist of, by their names, besides
///             `content` ("graph of a medial axis") and what the metadata tell: `blum_version`, `source`, `theta`,
///             `lambda`, `spacing`, `label`, `threshold`.
///   .graphml  an undirected graph for programs that take such (networkx, Gephi, igraph, yEd). Nodes, told apart by
///             their attribute `element`: `sheet3` (by the sheet's number), `seam0`, `junction0`, `patch0`, and
///             `curve0` for closed curves. Edges: `curve`, from junction to junction; `incidence`, between a sheet and
///             its seams, a seam and its junctions, a sheet and the junctions on it; `wall`, between a sheet and the
///             patches of its sides, with the `share` of the pairs that name the patch. The other attributes are the
///             members that are numbers, words or truths by their names; those within others by both
///             (`thickness_median`), vectors with _x, _y, _z. Metadata are attributes of the graph.
///
/// A file appears under its name only when it is complete.
/// @throws InvalidOption for another extension; FileError.
void write_graph(const std::filesystem::path& path, const AxisGraph& graph, const MedialMetadata& metadata = {});

}  // namespace blum
