#include "medial/axis_info.hpp"

#include <optional>
#include <string>

#include "blum/certificate/certificate.hpp"
#include "blum/io/graph_io.hpp"
#include "blum/io/medial_io.hpp"
#include "common/files.hpp"
#include "common/progress.hpp"
#include "medial/axis_graph_file.hpp"
#include "medial/medial_report.hpp"

namespace blum::cli {
namespace {

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}
Json or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

/// Returns theta and the other parameters of the axis, as recorded in its file.
std::string made_text(const MedialMetadata& m) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (m.theta) add("theta " + rounded_text(*m.theta));
  if (m.lambda) add("lambda " + rounded_text(*m.lambda));
  if (m.spacing) add("voxels of side " + rounded_text(*m.spacing));
  if (m.label) add("label " + std::to_string(*m.label));
  if (m.threshold) add("threshold " + rounded_text(*m.threshold));
  if (m.smooth) add("smooth surface of " + plural(static_cast<std::size_t>(*m.smooth), "iteration", "iterations"));
  if (m.weld) add(*m.weld > 0 ? "welded within " + rounded_text(*m.weld) : "welded");
  return text.empty() ? "not recorded in the file" : text;
}

std::string source_text(const MedialMetadata& m) {
  const std::string source = m.source.empty() ? "not recorded in the file" : m.source;
  return source + (m.solid_rule.empty() ? "" : ", as " + m.solid_rule);
}

/// @throws InvalidOption if the file contains no radii or no sheets.
AxisGraph graph_of(const MedialFile& file, const Context& context) {
  const Complex& axis = file.complex;
  if (!file.has_radii && !axis.positions.empty()) {
    throw InvalidOption(missing_medial_column("vertices", medial_columns::radius));
  }
  if (!file.has_labels && !axis.triangles.empty()) {
    throw InvalidOption(missing_medial_column("triangles", medial_columns::sheet));
  }
  AxisGraphOptions options;
  if (file.has_angles) options.homotopy_angle = file.metadata.theta;
  return axis_graph(axis, options, context);
}

}  // namespace

void report_axis(const std::filesystem::path& path, const std::optional<std::filesystem::path>& graph,
                 const ReportOptions& options) {
  Progress progress(!options.quiet);
  const Interrupt interrupt;
  const Context context = make_context(0, progress, interrupt);
  const ShownAxis shown = read_axis_or_curves(path);
  const MedialFile& file = shown.file;
  if (graph && !shown.is_axis)
    throw FileError("'" + path.string() + "' is a " + shown.content + "; --graph needs a medial axis");
  const MedialCounts counts = count(file.complex);
  const BettiNumbers betti = homology(file.complex.view(), context);
  Json graph_facts;
  std::string graph_line;
  if (graph) {
    const AxisGraph found = graph_of(file, context);
    write_graph(*graph, found, file.metadata);
    graph_facts = graph_json(found, *graph);
    graph_line = graph_text(found);
  }
  progress.clear();
  Box3 box;
  double least = 0;
  double most = 0;
  const MedialView axis(file.complex);
  for (std::size_t v = 0; v < axis.positions.size(); ++v) {
    least = box.is_empty() ? axis.radius[v] : std::min(least, axis.radius[v]);
    most = std::max(most, axis.radius[v]);
    box.extend(axis.positions[v]);
  }
  const bool has_radii = file.has_radii && !box.is_empty();
  const MedialMetadata& m = file.metadata;
  const Json json = {{"path", path.string()},
                     {"kind", shown.content},
                     {"counts", counts_json(counts, file.has_labels)},
                     {"betti", to_json(betti)},
                     {"certified", or_null(shown.is_certified)},
                     {"graph", graph_facts},
                     {"radius", has_radii ? Json::array({least, most}) : Json(nullptr)},
                     {"footprints", file.has_footprints},
                     {"source", or_null(m.source)},
                     {"written_by", or_null(m.version)},
                     {"deviation", or_null(m.deviation)},
                     {"solid_rule", or_null(m.solid_rule)},
                     {"theta", or_null(m.theta)},
                     {"nested_theta", file.nested ? Json(file.least_theta) : Json(nullptr)},
                     {"lambda", or_null(m.lambda)},
                     {"spacing", or_null(m.spacing)},
                     {"label", or_null(m.label)},
                     {"threshold", or_null(m.threshold)},
                     {"weld", or_null(m.weld)},
                     {"smooth", or_null(m.smooth)},
                     {"bounds", to_json(box)}};
  TextTable table;
  table.add("file", path.string() + ": " + shown.content);
  table.add(cells_label(shown), cells_text(shown));
  table.add("topology", betti_text(betti));
  if (!shown.certified.empty()) table.add("certified", shown.certified);
  if (graph) table.add("graph", graph_line);
  table.add("radii", has_radii ? rounded_text(least) + " to " + rounded_text(most) : "none in the file");
  table.add("footprints", file.has_footprints ? "two at each vertex" : "none in the file");
  if (!box.is_empty()) table.add("bounds", vector_text(box.lower) + " to " + vector_text(box.upper));
  if (file.nested) table.add("angles", angles_text(file.least_theta));
  table.add("of", source_text(m));
  table.add("made with", made_text(m));
  if (graph) table.add("wrote", graph->string());
  report(options, answer_json("info", json), table);
}

}  // namespace blum::cli
