#include "blum/io/graph_io.hpp"

#include <algorithm>
#include <string>

#include "blum/io/atomic_file.hpp"
#include "blum/io/formats.hpp"
#include "io/format_table.hpp"
#include "io/graph/graph_files.hpp"

namespace blum {

namespace graph_files {

Attributes attributes_of(const MedialMetadata& metadata) {
  Attributes out;
  const auto add = [&](const char* name, const auto& value) {
    if (value) out.emplace_back(name, *value);
  };
  if (!metadata.version.empty()) out.emplace_back("blum_version", metadata.version);
  if (!metadata.source.empty()) out.emplace_back("source", metadata.source);
  add("theta", metadata.theta);
  add("lambda", metadata.lambda);
  add("spacing", metadata.spacing);
  add("deviation", metadata.deviation);
  add("label", metadata.label);
  add("threshold", metadata.threshold);
  if (metadata.smooth) out.emplace_back("smooth", std::int64_t{*metadata.smooth});
  return out;
}

}  // namespace graph_files

void write_graph(const std::filesystem::path& path, const AxisGraph& graph, const MedialMetadata& metadata) {
  const auto format = GraphFormat::of(path, FileAccess::write, "graphs of medial axes");
  const std::string text = formats::code_of(format).text_of_axis(graph, metadata);
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

namespace formats {

constinit const GraphCode graph_json{graph_files::json_text, graph_files::json_text};
constinit const GraphCode graph_graphml{graph_files::graphml_text, graph_files::graphml_text};

}  // namespace formats

}  // namespace blum

namespace blum::graph_files {
namespace {

/// Returns true if a value is written on one line. These are numbers, lists and nested lists of numbers, and objects
/// whose values are numbers or lists of numbers.
bool is_flat(const Json& json, int depth = 0) {
  if (json.is_primitive()) return true;
  if (depth > (json.is_object() ? 0 : 1)) return false;
  return std::all_of(json.begin(), json.end(), [&](const Json& part) { return is_flat(part, depth + 1); });
}

std::string flat_text(const Json& json) {
  // File names may contain invalid UTF-8, which is replaced.
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Appends a value. Each part for which is_flat() is true takes one line, because polylines have thousands of numbers.
void append(const Json& json, std::string& text, std::size_t indent) {
  if (json.empty() || is_flat(json)) {
    text += flat_text(json);
    return;
  }
  text += json.is_object() ? "{" : "[";
  const char* between = "\n";
  for (const auto& [key, part] : json.items()) {
    text += between + std::string(indent + 2, ' ');
    if (json.is_object()) text += flat_text(key) + ": ";
    append(part, text, indent + 2);
    between = ",\n";
  }
  text += "\n" + std::string(indent, ' ') + (json.is_object() ? "}" : "]");
}

}  // namespace

std::string text_of(const Json& json) {
  std::string text;
  append(json, text, 0);
  return text + "\n";
}

std::string json_text(const AxisGraph& graph, const MedialMetadata& metadata) {
  Json json = {{"content", "graph of a medial axis"}};
  for (const auto& [name, value] : attributes_of(metadata)) {
    std::visit([&, &key = name](const auto& known) { json[key] = known; }, value);
  }
  json.update(json_of(graph));
  return text_of(json);
}

}  // namespace blum::graph_files
