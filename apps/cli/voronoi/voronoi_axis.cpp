#include "voronoi/voronoi_axis.hpp"

#include <array>
#include <utility>

#include "blum/axis/axis_graph.hpp"
#include "blum/axis/collapse_axis.hpp"
#include "blum/axis/decimate.hpp"
#include "blum/io/certified_axis.hpp"
#include "blum/io/graph_io.hpp"
#include "blum/io/medial_io.hpp"
#include "blum/medial_axis/axis_forms.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/options.hpp"
#include "medial/axis_graph_file.hpp"
#include "medial/medial_report.hpp"

namespace blum::cli {

namespace fs = std::filesystem;

void VoronoiAxisTexts::add_to(const Command& command) {
  add_text_option(command, "--theta", theta, "DEG",
                  "With --medial: keep where footprints are seen more than DEG apart (default 1), and what joins that");
  add_text_option(command, "--simplify", simplify, "TOL",
                  "With --medial: fewer triangles, at most TOL mesh units away (default 0: all)");
  add_graph_option(command, graph,
                   "Its regions, walls, seams and junctions as a graph; with --medial its sheets, seams, curves and "
                   "junctions");
}

std::string VoronoiAxisTexts::given() const {
  if (theta) return "--theta";
  return simplify ? "--simplify" : "";
}

VoronoiAxisOptions parse_axis_options(const VoronoiAxisTexts& texts) {
  VoronoiAxisOptions out;
  if (texts.theta) out.theta = parse_angle("--theta", *texts.theta);
  if (texts.simplify) out.simplify = parse_non_negative("--simplify", *texts.simplify);
  out.graph = parse_graph(texts.graph);
  return out;
}

namespace {

MedialMetadata metadata_of(const VoronoiAxisOptions& options, const fs::path& source,
                           const std::optional<double>& weld) {
  MedialMetadata out;
  out.source = source.filename().string();
  out.version = BLUM_VERSION;
  out.theta = options.theta;
  out.solid_rule = to_string(SolidRule::polyhedron);
  out.weld = weld;
  return out;
}

/// With few vertices, if that is certified, or with all.
std::vector<AxisForm> forms_of(const VoronoiAxisOptions& options) {
  std::vector<AxisForm> out;
  if (options.simplify > 0) out.push_back({false, options.simplify, "its vertices all stay"});
  out.emplace_back();
  return out;
}

Json add_graph(VoronoiAxis& out, const Complex& axis, const SolidInput& input, const VoronoiAxisOptions& options,
               const MedialMetadata& metadata, const Context& context) {
  if (!options.graph) return nullptr;
  Stopwatch watch;
  AxisGraphOptions how;
  how.homotopy_angle = options.theta;
  const AxisGraph graph = axis_graph(axis, input.mesh.mesh, how, context);
  out.drafts.emplace_back(*options.graph);
  write_graph(out.drafts.back().path(), graph, metadata);
  out.phases.push_back({"graph", watch.lap()});
  out.table.add("graph", graph_text(graph));
  return graph_json(graph, *options.graph);
}

}  // namespace

VoronoiAxis make_voronoi_axis(const Complex& walls, const SolidInput& input, const VoronoiAxisOptions& options,
                              const fs::path& source, const std::optional<double>& weld, const fs::path& output,
                              const Context& context) {
  VoronoiAxis out;
  Stopwatch watch;
  const Complex whole = collapse_axis(walls, options.theta, context);
  out.phases.push_back({"collapse", watch.lap()});
  MedialMetadata metadata = metadata_of(options, source, weld);
  out.drafts.emplace_back(output);
  const auto make = [&](const AxisForm& form) {
    DecimatedAxis lean = decimate(whole, form, context);
    const bool is_lean = lean.axis.positions.size() < lean.vertices_before;
    metadata.deviation = is_lean ? std::optional(lean.deviation) : std::nullopt;
    out.phases.push_back({"simplify", watch.lap()});
    return lean;
  };
  const SolidVerifier verifier(input);
  const auto certify = [&](const DecimatedAxis& made) {
    const fs::path& draft = out.drafts.front().path();
    write_medial(draft, made.axis, metadata, context);
    out.phases.push_back({"write", watch.lap()});
    MedialFile written = read_axis(draft);
    written.metadata.solid_rule = metadata.solid_rule;  // .obj and .ma say nothing of it
    Certificate certificate = verifier.certificate_of(written, {}, context);
    out.phases.push_back({"certificate", watch.lap()});
    return certificate;
  };
  const CertifiedAxis made = first_certified(forms_of(options), make, certify);
  const MedialCounts counts = count(made.axis.axis);
  for (const std::string& text : made.warnings) out.warnings.emplace_back(WarningCode::form_not_certified, text);
  out.mismatches = made.certificate.mismatches;
  out.table.add("axis", counts_text(counts, true));
  if (metadata.deviation) {
    out.table.add("simplified", "from " + count_text(made.axis.vertices_before) + " vertices; moved by at most " +
                                    rounded_text(made.axis.deviation));
  }
  out.json = {{"theta", options.theta},
              {"counts", counts_json(counts, true)},
              {"deviation", made.axis.deviation},
              {"vertices_before", made.axis.vertices_before},
              {"graph", add_graph(out, made.axis.axis, input, options, metadata, context)},
              {"certificate", certificate_json(made.certificate, false)}};
  add_certificate(out.table, made.certificate, false);
  return out;
}

}  // namespace blum::cli
