// Blum: files of graphs of medial axes (JSON, GraphML). SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "blum/axis/axis_graph.hpp"
#include "blum/core/error.hpp"
#include "blum/io/medial_io.hpp"

namespace blum {

/// Writes the graph of a medial axis. The extension selects the format.
///
///   `.json`     Everything: an object with the members of AxisGraph, including nested members, under the same names as
///               in C++. The object begins with `content` ("graph of a medial axis") and the known metadata:
///               `blum_version`, `source`, `theta`, `lambda`, `spacing`, `deviation`, `label`, `threshold` and
///               `smooth`.
///   `.graphml`  An undirected graph for programs such as networkx, Gephi, igraph and yEd. The attribute `element` is
///               the kind of a node or edge. Examples of nodes are `sheet3` (the sheet with index 3), `seam0`,
///               `junction0`, `patch0` and, for closed curves, `curve0`. An edge `curve` joins two junctions. An edge
///               `incidence` joins a sheet and one of its seams. Edges `incidence` also join a seam and one of its
///               junctions, and a sheet and a junction on it. An edge `wall` joins a sheet and a patch on one of its
///               sides. The attribute `share` of a wall is the sum of the shares of the sheet's patch pairs that
///               contain the patch. The other attributes are all members that are numbers, words or truth values, with
///               their names. A nested member has the names of both members (`thickness_median`). Names of vector
///               components end with _x, _y, _z. Metadata are attributes of the graph.
///
/// A file appears under its name only when it is complete.
/// @throws InvalidOption for another extension.
/// @throws FileError.
void write_graph(const std::filesystem::path& path, const AxisGraph& graph, const MedialMetadata& metadata = {});

}  // namespace blum
