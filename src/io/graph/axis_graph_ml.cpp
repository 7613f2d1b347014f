#include <map>
#include <set>
#include <string>
#include <utility>

#include "io/graph/graph_files.hpp"
#include "io/graph/graph_ml.hpp"

namespace blum::graph_files {
namespace {

/// The graph of an axis as nodes and edges.
class FlatAxis : public FlatGraph {
 public:
  explicit FlatAxis(const AxisGraph& graph) {
    for (const AxisSheet& sheet : graph.sheets) add_node("sheet", sheet.sheet, sheet);
    add_nodes("seam", graph.seams);
    for (std::size_t k = 0; k < graph.curves.size(); ++k) {
      if (graph.curves[k].closed) add_node("curve", k, graph.curves[k]);
    }
    add_nodes("junction", graph.junctions);
    add_nodes("patch", graph.patches);
    for (std::size_t k = 0; k < graph.curves.size(); ++k) add_curve(graph.curves[k], k);
    for (const AxisSheet& sheet : graph.sheets) {
      for (const std::uint32_t seam : sheet.seams)
        add_incidence(numbered("sheet", sheet.sheet), numbered("seam", seam));
    }
    for (std::size_t j = 0; j < graph.junctions.size(); ++j) {
      const std::set<std::uint32_t> seams(graph.junctions[j].seams.begin(), graph.junctions[j].seams.end());
      for (const std::uint32_t s : seams) add_incidence(numbered("seam", s), numbered("junction", j));
      for (const std::uint32_t s : graph.junctions[j].sheets) {
        add_incidence(numbered("sheet", s), numbered("junction", j));
      }
    }
    for (const AxisSheet& sheet : graph.sheets) add_walls(sheet);
  }

 private:
  void add_curve(const AxisLine& curve, std::size_t number) {
    if (!curve.junctions) return;
    Attributes attributes{{"element", std::string("curve")}, {"curve", static_cast<std::int64_t>(number)}};
    add_members(curve, attributes);
    edges.push_back({numbered("junction", (*curve.junctions)[0]), numbered("junction", (*curve.junctions)[1]),
                     std::move(attributes)});
  }
  void add_walls(const AxisSheet& sheet) {
    std::map<std::uint32_t, double> shares;
    for (const AxisPatchPair& pair : sheet.patch_pairs) {
      std::set<std::uint32_t> named(pair.first.begin(), pair.first.end());
      named.insert(pair.second.begin(), pair.second.end());
      for (const std::uint32_t patch : named) shares[patch] += pair.share;
    }
    for (const auto& [patch, share] : shares) {
      edges.push_back({numbered("sheet", sheet.sheet),
                       numbered("patch", patch),
                       {{"element", std::string("wall")}, {"share", share}}});
    }
  }
};

}  // namespace

std::string graphml_text(const AxisGraph& graph, const MedialMetadata& metadata) {
  Attributes whole = told(metadata);
  add_members(graph, whole);
  return graphml_text("axis", whole, FlatAxis(graph));
}

}  // namespace blum::graph_files
