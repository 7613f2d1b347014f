#include "blum/io/voronoi_io.hpp"

#include <string>

#include "blum/core/error.hpp"
#include "blum/core/exact_text.hpp"
#include "blum/io/atomic_file.hpp"
#include "blum/io/formats.hpp"
#include "io/format_table.hpp"
#include "io/graph/graph_files.hpp"

namespace blum {

FileMetadata voronoi_metadata(VoronoiPart part, std::optional<double> hausdorff_bound, std::size_t failing_cubes,
                              std::string_view version) {
  FileMetadata out{{"content", part == VoronoiPart::all ? "Voronoi diagram" : "walls of a Voronoi diagram"},
                   {"blum_version", std::string(version)},
                   {"certified", hausdorff_bound ? "true" : "false"}};
  if (hausdorff_bound) {
    if (*hausdorff_bound > 0) out.emplace_back("hausdorff_bound", exact_text(*hausdorff_bound));
  } else {
    out.emplace_back("failing_cubes", std::to_string(failing_cubes));
  }
  return out;
}

namespace {

using graph_files::FlatGraph;

constexpr const char* content = "graph of a Voronoi diagram";

/// Adds the metadata of the complex, except `content`, which is different for graphs.
template <class Add>
void add_stated(const FileMetadata& metadata, const Add& add) {
  for (const auto& [key, value] : metadata) {
    if (key != "content") add(key, value);
  }
}

/// Returns a graph with one node for each site, wall, seam and junction. The node of a site represents its region. In a
/// graph of patches, patches replace the sites.
FlatGraph flattened(const VoronoiGraph& graph, std::span<const VoronoiSite> sites) {
  const auto region = [](std::int32_t site) { return FlatGraph::numbered("region", static_cast<std::size_t>(site)); };
  FlatGraph out;
  for (std::size_t k = 0; k < graph.patches.size(); ++k) out.add_node("region", k, graph.patches[k]);
  for (std::size_t k = 0; k < sites.size() && graph.patches.empty(); ++k) out.add_node("region", k, sites[k]);
  for (const VoronoiRegion& one : graph.regions) {
    graph_files::add_members(one, out.nodes[static_cast<std::size_t>(one.site)].attributes);
  }
  out.add_nodes("wall", graph.walls);
  out.add_nodes("seam", graph.seams);
  out.add_nodes("junction", graph.junctions);
  for (std::size_t k = 0; k < graph.walls.size(); ++k) {
    const VoronoiWall& wall = graph.walls[k];
    for (const std::int32_t site : {wall.site_a, wall.site_b}) {
      out.add_incidence(region(site), FlatGraph::numbered("wall", k));
    }
    for (const std::uint32_t seam : wall.seams) {
      out.add_incidence(FlatGraph::numbered("wall", k), FlatGraph::numbered("seam", seam));
    }
  }
  for (std::size_t k = 0; k < graph.seams.size(); ++k) {
    for (const std::uint32_t junction : graph.seams[k].junctions) {
      out.add_incidence(FlatGraph::numbered("seam", k), FlatGraph::numbered("junction", junction));
    }
  }
  for (const VoronoiRegion& one : graph.regions) {
    for (const VoronoiNeighbour& other : one.neighbours) {
      if (other.site < one.site) continue;
      out.edges.push_back(
          {region(one.site), region(other.site), {{"element", std::string("neighbours")}, {"area", other.area}}});
    }
  }
  return out;
}

}  // namespace

void write_voronoi_graph(const std::filesystem::path& path, const VoronoiGraph& graph,
                         std::span<const VoronoiSite> sites, const FileMetadata& metadata) {
  const std::size_t count = graph.patches.empty() ? sites.size() : graph.patches.size();
  const auto is_known = [&](std::int32_t site) { return site >= 0 && static_cast<std::size_t>(site) < count; };
  for (const VoronoiRegion& region : graph.regions) {
    if (!is_known(region.site)) throw InvalidOption("graph of a Voronoi diagram: it names sites that are not listed");
  }
  for (const VoronoiWall& wall : graph.walls) {
    if (is_known(wall.site_a) && is_known(wall.site_b)) continue;
    throw InvalidOption("graph of a Voronoi diagram: it names sites that are not listed");
  }
  const auto format = GraphFormat::of(path, FileAccess::write, "graphs of Voronoi diagrams");
  const std::string text = formats::code_of(format).text_of_diagram(graph, sites, metadata);
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

namespace graph_files {

std::string json_text(const VoronoiGraph& graph, std::span<const VoronoiSite> sites, const FileMetadata& metadata) {
  Json json = {{"content", content}};
  add_stated(metadata, [&](const std::string& key, const std::string& value) { json[key] = value; });
  json["sites"] = json_of(std::vector<VoronoiSite>(sites.begin(), sites.end()));
  json.update(json_of(graph));
  return text_of(json);
}

std::string graphml_text(const VoronoiGraph& graph, std::span<const VoronoiSite> sites, const FileMetadata& metadata) {
  Attributes whole{{"content", std::string(content)}};
  add_stated(metadata, [&](const std::string& key, const std::string& value) { whole.emplace_back(key, value); });
  return graphml_text("diagram", whole, flattened(graph, sites));
}

}  // namespace graph_files
}  // namespace blum
