#include "blum/io/graph_io.hpp"

#include <string>

#include "blum/io/atomic_file.hpp"
#include "blum/io/formats.hpp"
#include "io/format_table.hpp"
#include "io/graph/graph_files.hpp"

namespace blum {

namespace graph_files {

Attributes told(const MedialMetadata& metadata) {
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
