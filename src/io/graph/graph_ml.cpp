#include "io/graph/graph_files.hpp"

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "blum/core/exact_text.hpp"

namespace blum::graph_files {
namespace {

/// Returns a text for XML, with special characters replaced by entities.
std::string escaped(const std::string& text) {
  // File names may contain invalid UTF-8. dump() replaces invalid bytes by U+FFFD.
  using nlohmann::json;
  const auto valid = json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
  std::string out;
  for (const char c : valid) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        if (static_cast<unsigned char>(c) < 0x20) {
          out += "\xEF\xBF\xBD";  // U+FFFD, because XML 1.0 does not allow control characters
        } else {
          out += c;
        }
    }
  }
  return out;
}

std::string text_of(const Attribute& attribute) {
  return std::visit(
      []<class T>(const T& value) -> std::string {
        if constexpr (std::same_as<T, bool>) {
          return value ? "true" : "false";
        } else if constexpr (std::same_as<T, std::string>) {
          return escaped(value);
        } else if constexpr (std::same_as<T, double>) {
          return exact_text(value);
        } else {
          return std::to_string(value);
        }
      },
      attribute.second);
}

/// Declarations of attributes of the graph, of nodes or of edges. An attribute is declared when it first occurs.
class Keys {
 public:
  explicit Keys(std::string_view of) : of_(of) {}

  /// Returns the values of attributes, one per line.
  /// @param indent  indentation of each line.
  std::string data(const Attributes& attributes, std::string_view indent) {
    std::string out;
    for (const Attribute& attribute : attributes) {
      out += std::string(indent) + "<data key=\"" + key_of(attribute) + "\">" + text_of(attribute) + "</data>\n";
    }
    return out;
  }
  [[nodiscard]] const std::string& declarations() const { return declarations_; }

 private:
  const std::string& key_of(const Attribute& attribute) {
    static constexpr std::array<std::string_view, 4> types{"long", "double", "boolean", "string"};
    const auto [at, is_new] = keys_.try_emplace(attribute.first, of_ + "_" + attribute.first);
    if (is_new) {
      declarations_ += "  <key id=\"" + at->second + "\" for=\"" + of_ + "\" attr.name=\"" + attribute.first +
                       "\" attr.type=\"" + std::string(types[attribute.second.index()]) + "\"/>\n";
    }
    return at->second;
  }

  std::string of_;
  std::string declarations_;
  std::map<std::string, std::string> keys_;
};

}  // namespace

std::string graphml_text(const char* id, const Attributes& whole, const FlatGraph& graph) {
  Keys of_graph("graph");
  Keys of_nodes("node");
  Keys of_edges("edge");
  std::string body = of_graph.data(whole, "    ");
  for (const FlatGraph::Node& node : graph.nodes) {
    body += "    <node id=\"" + node.name + "\">\n" + of_nodes.data(node.attributes, "      ") + "    </node>\n";
  }
  for (const FlatGraph::Edge& edge : graph.edges) {
    body += "    <edge source=\"" + edge.from + "\" target=\"" + edge.to + "\">\n" +
            of_edges.data(edge.attributes, "      ") + "    </edge>\n";
  }
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\"\n"
         "         xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\"\n"
         "         xsi:schemaLocation=\"http://graphml.graphdrawing.org/xmlns "
         "http://graphml.graphdrawing.org/xmlns/1.0/graphml.xsd\">\n" +
         of_graph.declarations() + of_nodes.declarations() + of_edges.declarations() + "  <graph id=\"" + id +
         "\" edgedefault=\"undirected\">\n" + body + "  </graph>\n</graphml>\n";
}

namespace {

/// Graph of an axis in the form that GraphML needs: nodes and edges.
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
  Attributes whole = attributes_of(metadata);
  add_members(graph, whole);
  return graphml_text("axis", whole, FlatAxis(graph));
}

}  // namespace blum::graph_files
