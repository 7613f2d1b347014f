// Proves that JSON files hold the whole graph, and GraphML files edges between declared nodes, with any characters in
// names.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "blum/core/error.hpp"
#include "blum/io/graph_io.hpp"
#include "blum/io/voronoi_io.hpp"
#include "blum/shapes/generators.hpp"
#include "io/text/vtk_xml.hpp"
#include "unit/io/temporary_folder.hpp"

namespace blum {
namespace {

using nlohmann::json;

class GraphFiles : public testing::Test {
 protected:
  std::string written(const char* name, const AxisGraph& graph, const MedialMetadata& metadata = {}) {
    write_graph(folder_ / name, graph, metadata);
    return test::file_content(folder_ / name);
  }

  test::TemporaryFolder folder_;
};

/// Two sheets at a closed seam, a curve between two junctions, a closed curve, two patches.
AxisGraph example() {
  AxisGraph graph;
  AxisSheet sheet;
  sheet.sheet = 4;
  sheet.area = 0.1;
  sheet.thickness = {1, 1.5, 2, 3};
  sheet.euler_characteristic = -1;
  sheet.seams = {0};
  sheet.patch_pairs = {{{0}, {1}, 0.75}, {{0, 1}, {1}, 0.25}};
  graph.sheets = {sheet, sheet};
  graph.sheets[0].sheet = 1;
  graph.sheets[0].patch_pairs.clear();
  AxisLine loop;
  loop.closed = true;
  loop.sheets = {1, 4};
  loop.vertices = {5, 6, 7, 5};
  loop.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}};
  graph.seams = {loop};
  AxisLine curve;
  curve.length = 1.5;
  curve.junctions = {0, 1};
  curve.radii = {0.5, 0.25};
  graph.curves = {curve, loop};
  graph.junctions.resize(2);
  graph.junctions[0].kind = JunctionKind::curve_foot;
  graph.junctions[0].sheets = {4};
  graph.junctions[1].kind = JunctionKind::curve_end;
  graph.junctions[1].position = {1, 2, 3};
  for (AxisJunction& junction : graph.junctions) junction.curves = {0};
  graph.patches.resize(2);
  return graph;
}

MedialMetadata metadata() {
  MedialMetadata m;
  m.source = "a<b>&\"c'\x01\xff.stl";
  m.version = "1.2.3";
  m.theta = 62.5;
  m.label = 3;
  return m;
}

TEST_F(GraphFiles, JsonHoldsTheWholeGraph) {
  const json graph = json::parse(written("g.json", example(), metadata()));
  EXPECT_EQ(graph["content"], "graph of a medial axis");
  EXPECT_EQ(graph["blum_version"], "1.2.3");
  EXPECT_EQ(graph["theta"], 62.5);
  EXPECT_EQ(graph["label"], 3);
  EXPECT_FALSE(graph.contains("lambda"));
  EXPECT_EQ(graph["sheets"][1]["thickness"]["median"], 2);
  EXPECT_EQ(graph["sheets"][1]["patch_pairs"][1]["first"], json({0, 1}));
  EXPECT_EQ(graph["seams"][0]["junctions"], nullptr);
  EXPECT_EQ(graph["seams"][0]["points"][2], json({1.0, 1.0, 0.0}));
  EXPECT_EQ(graph["curves"][0]["radii"], json({0.5, 0.25}));
  EXPECT_EQ(graph["junctions"][0]["kind"], "curve_foot");
  EXPECT_EQ(graph["junctions"][1]["position"], json({1.0, 2.0, 3.0}));
}

TEST_F(GraphFiles, JsonOfAnEmptyGraphHasEmptyLists) {
  const json graph = json::parse(written("g.JSON", {}));
  for (const char* const list : {"sheets", "seams", "curves", "junctions", "patches"}) {
    EXPECT_EQ(graph[list], json::array());
  }
}

TEST_F(GraphFiles, GraphmlDeclaresAllKeysAndNodes) {
  const std::string text = written("g.graphml", example(), metadata());
  EXPECT_NE(text.find(">a&lt;b&gt;&amp;&quot;c'\xEF\xBF\xBD\xEF\xBF\xBD.stl<"), std::string::npos);
  const std::string name = "g.graphml";
  volume_io::XmlTags tags(text, name);
  std::set<std::string_view> keys;
  std::set<std::string_view> nodes;
  std::multiset<std::pair<std::string_view, std::string_view>> edges;
  std::map<std::string_view, std::string_view> of_curve;
  std::string_view last;
  while (const auto tag = tags.next()) {
    EXPECT_TRUE(tag->name != "key" || keys.insert(*tag->find("id")).second);
    EXPECT_TRUE(tag->name != "node" || nodes.insert(*tag->find("id")).second);
    if (tag->name == "edge") {
      last = *tag->find("source");
      EXPECT_TRUE(nodes.contains(*tag->find("source")) && nodes.contains(*tag->find("target")));
      edges.emplace(*tag->find("source"), *tag->find("target"));
    }
    if (tag->name == "data") {
      EXPECT_TRUE(keys.contains(*tag->find("key"))) << *tag->find("key");
      if (last == "junction0") of_curve[*tag->find("key")] = tag->text;
    }
  }
  EXPECT_EQ(nodes, (std::set<std::string_view>{"sheet1", "sheet4", "seam0", "curve1", "junction0", "junction1",
                                               "patch0", "patch1"}));
  EXPECT_EQ(edges, (std::multiset<std::pair<std::string_view, std::string_view>>{{"junction0", "junction1"},
                                                                                 {"sheet1", "seam0"},
                                                                                 {"sheet4", "seam0"},
                                                                                 {"sheet4", "junction0"},
                                                                                 {"sheet4", "patch0"},
                                                                                 {"sheet4", "patch1"}}));
  EXPECT_EQ(of_curve["edge_length"], "1.5");
  EXPECT_EQ(of_curve["edge_closed"], "false");
}

TEST_F(GraphFiles, VoronoiGraphsNameTheirSites) {
  const VoronoiComplex box = voronoi_complex(make_box());
  VoronoiGraph graph = voronoi_graph(box.complex);
  const std::vector<VoronoiSite> sites = voronoi_sites(make_box());
  const FileMetadata about = voronoi_metadata(VoronoiPart::all, box.report.hausdorff_bound, 0, "1.2.3");
  write_voronoi_graph(folder_ / "g.json", graph, sites, about);
  const json read = json::parse(test::file_content(folder_ / "g.json"));
  EXPECT_EQ(read["content"], "graph of a Voronoi diagram");
  EXPECT_EQ(read["certified"], "true");
  EXPECT_EQ(read["sites"].size(), 6U);
  EXPECT_EQ(read["sites"][0]["kind"], "face");
  EXPECT_EQ(read["walls"].size(), graph.walls.size());
  EXPECT_EQ(read["regions"][2]["neighbours"].size(), 4U);
  write_voronoi_graph(folder_ / "g.graphml", graph, sites, about);
  const std::string text = test::file_content(folder_ / "g.graphml");
  for (const char* const part : {"<node id=\"region5\">", "target=\"wall0\"", ">neighbours<", ">1.2.3<"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part;
  }
  const std::vector<VoronoiSite> fewer(sites.begin(), sites.end() - 1);
  EXPECT_THROW(write_voronoi_graph(folder_ / "h.json", graph, fewer), InvalidOption);
  EXPECT_THROW(write_voronoi_graph(folder_ / "h.gml", graph, sites), InvalidOption);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "h.json"));
}

TEST_F(GraphFiles, OtherExtensionsAreRefused) {
  for (const char* const name : {"g.gml", "g", "g.json.gz"}) {
    EXPECT_THROW(write_graph(folder_ / name, {}), InvalidOption) << name;
  }
  EXPECT_THROW(write_graph(folder_.path() / "none" / "g.json", {}), FileError);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

}  // namespace
}  // namespace blum
