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

/// Returns the metadata of a Voronoi diagram for write_complex(). The keys are `content` ("Voronoi diagram", or "walls
/// of a Voronoi diagram" if the surface is not included), `blum_version`, and `certified`. If the complex is certified,
/// the metadata also contain `hausdorff_bound` (mesh units). If the complex is not certified, the metadata contain
/// `failing_cubes`, the number of cubes that fail the check.
/// @param hausdorff_bound  the bound in VoronoiReport; nullopt if the complex is not certified. The value 0 means that
/// the bound is unknown; it is not written.
[[nodiscard]] FileMetadata voronoi_metadata(VoronoiPart part, std::optional<double> hausdorff_bound,
                                            std::size_t failing_cubes, std::string_view version);

/// Writes the graph of a Voronoi diagram. The extension selects the format.
///
///   `.json`     Everything: `content` ("graph of a Voronoi diagram"), the metadata, `sites` and the members of
///               VoronoiGraph, under the same names as in C++.
///   `.graphml`  An undirected graph for programs such as networkx, Gephi, igraph and yEd. The attribute `element` is
///               the kind of a node or edge. Examples of nodes are `region3` (the region of site 3, with the site's
///               `kind`), `wall0`, `seam0` and `junction0`. An edge `incidence` joins a region and one of its walls.
///               Edges `incidence` also join a wall and one of its seams, and a seam and one of its junctions. If the
///               graph has regions, an edge `neighbours` joins two neighbouring regions. The attribute `area` of this
///               edge is the area of the walls between the two regions. In a graph of patches, a node such as `region3`
///               is the region of a patch, with the patch's `kind`. The other attributes are all members that are
///               numbers or words, with their names; components of vectors end with _x, _y, _z. Metadata are attributes
///               of the graph.
///
/// A file appears under its name only when it is complete.
/// @param graph     result of voronoi_graph().
/// @param sites     all sites, from voronoi_sites().
/// @param metadata  for example voronoi_metadata().
/// @throws InvalidOption for another extension, and if the graph has an index of a missing site.
/// @throws FileError.
void write_voronoi_graph(const std::filesystem::path& path, const VoronoiGraph& graph,
                         std::span<const VoronoiSite> sites, const FileMetadata& metadata = {});

}  // namespace blum
