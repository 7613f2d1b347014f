// Blum: what files of Voronoi diagrams say, and files of their graphs (JSON, GraphML). SPDX-License-Identifier:
// Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

#include "blum/io/file_metadata.hpp"
#include "blum/voronoi/voronoi_complex.hpp"
#include "blum/voronoi/voronoi_graph.hpp"
#include "blum/voronoi/voronoi_sites.hpp"

namespace blum {

/// What write_complex() is told of a Voronoi diagram: `content` ("Voronoi diagram", or "walls of a Voronoi diagram"
/// without the surface), `blum_version`, `certified`, and then `hausdorff_bound` (mesh units), else `failing_cubes`,
/// how many do not pass.
/// @param hausdorff_bound  of VoronoiReport; nullopt where the complex is not certified.
[[nodiscard]] FileMetadata voronoi_metadata(VoronoiPart part, std::optional<double> hausdorff_bound,
                                            std::size_t failing_cubes, std::string_view version);

/// Writes the graph of a Voronoi diagram; the format goes by the extension.
///
///   .json     all of it: `content` ("graph of a Voronoi diagram"), the metadata, `sites` and the members of
///             VoronoiGraph, by their names.
///   .graphml  an undirected graph for programs that take such (networkx, Gephi, igraph, yEd). Nodes, told apart by
///             their attribute `element`: `region3` (by its site, of which it has the `kind`, too), `wall0`, `seam0`
///             and `junction0`. Edges: `incidence`, between a region and its walls, a wall and its seams, a seam and
///             its junctions; `neighbours`, between two regions, with the `area` of the walls between them (where the
///             graph has regions). The other attributes are the members that are numbers or words by their names,
///             vectors with _x, _y, _z. Metadata are attributes of the graph.
///
/// A file appears under its name only when it is complete.
/// @param graph  of voronoi_graph().  @param sites  of voronoi_sites(), all.
/// @param metadata  such as voronoi_metadata().
/// @throws InvalidOption for another extension, and where the graph names a site that is none; FileError.
void write_voronoi_graph(const std::filesystem::path& path, const VoronoiGraph& graph,
                         std::span<const VoronoiSite> sites, const FileMetadata& metadata = {});

}  // namespace blum
