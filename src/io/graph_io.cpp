#include "blum/io/graph_io.hpp"

#include <string>

#include "blum/io/atomic_file.hpp"
#include "blum/io/formats.hpp"
#include "io/graph_files.hpp"

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
  const std::string extension = file_extension(path);
  if (extension != ".json" && extension != ".graphml") {
    throw InvalidOption("'" + path.string() +
                        "': graphs of medial axes are written to .json, .graphml files; use one of these extensions");
  }
  const std::string text =
      extension == ".json" ? graph_files::json_text(graph, metadata) : graph_files::graphml_text(graph, metadata);
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace blum
