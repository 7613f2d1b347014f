// Blum: metadata of Voronoi diagrams, and files of their graphs (JSON, GraphML). SPDX-License-Identifier: Apache-2.0
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

/// Returns the metadata of a Voronoi diagram for write_complex(). They are `content` ("Voronoi diagram", or "walls of a
/// Voronoi diagram" without the surface), `blum_version`, and `certified`. A certified complex has `hausdorff_bound`
/// (mesh units), others `failing_cubes`, the number of cubes that do not pass.
/// @param hausdorff_bound  that of VoronoiReport; nullopt if the complex is not certified.
[[nodiscard]] FileMetadata voronoi_metadata(VoronoiPart part, std::optional<double> hausdorff_bound,
                                            std::size_t failing_cubes, std::string_view version);

/// Writes the graph of a Voronoi diagram. The extension selects the format.
///
///   `.json`     Everything: `content` ("graph of a Voronoi diagram"), the metadata, `sites` and the members of
///               VoronoiGraph, by their names.
///   `.graphml`  An undirected graph for programs such as networkx, Gephi, igraph and yEd. The attribute `element`
///               holds the kind of a node. Nodes are `region3` (by its site, with the site's `kind`), `wall0`, `seam0`
///               and `junction0`. Edges `incidence` join a region and its walls, a wall and its seams, or a seam and
///               its junctions. Edges `neighbours` join two regions, if the graph has regions. Their `area` is that of
///               the walls between the regions. The other attributes are the members that are numbers or words, by
///               their names, vectors with _x, _y, _z. Metadata are attributes of the graph.
///
/// A file appears under its name only when it is complete.
/// @param graph     result of voronoi_graph().
/// @param sites     all sites, from voronoi_sites().
/// @param metadata  for example voronoi_metadata().
/// @throws InvalidOption for another extension, and if the graph names a missing site.
/// @throws FileError.
void write_voronoi_graph(const std::filesystem::path& path, const VoronoiGraph& graph,
                         std::span<const VoronoiSite> sites, const FileMetadata& metadata = {});

}  // namespace blum
