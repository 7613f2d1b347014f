#include "voronoi/voronoi_axis.hpp"

#include <utility>

#include "blum/axis/axis_graph.hpp"
#include "blum/axis/collapse_axis.hpp"
#include "blum/certified/certified_axis.hpp"
#include "blum/io/graph_io.hpp"
#include "blum/io/medial_io.hpp"
#include "commands.hpp"
#include "common/common_options.hpp"
#include "common/options.hpp"
#include "medial/axis_graph_file.hpp"
#include "medial/medial_report.hpp"

namespace blum::cli {

namespace fs = std::filesystem;

void VoronoiAxisTexts::add_to(const Command& command) {
  add_text_option(command, "--theta", theta, "DEG",
                  "With --medial: keep cells with separation angles above DEG degrees, 0 to 180 (default 1), and cells "
                  "that connect them");
  add_text_option(
      command, "--decimate", decimate, "TOL",
      "With --medial: reduce the number of triangles; the axis moves by at most TOL mesh units (default 0: keep all)");
  add_graph_option(command, graph,
                   "Also write a graph of regions, walls, seams and junctions, or with --medial of sheets, seams, "
                   "curves and junctions");
  add_text_option(command, "--patch-angle", patch_angle, "DEG",
                  "Join sites of smooth patches: faces that meet in edges bent by at most DEG degrees, 0 to 180 (30 "
                  "suits most meshes). The graph is that of the patches; files get columns patch_a and patch_b");
  add_text_option(command, "--patch-fit", patch_fit, "TOL",
                  "Patches are planes, spheres, cylinders and cones whose vertices lie within TOL mesh units. Edges "
                  "inside them bend by at most --patch-angle (default 30)");
}

std::string VoronoiAxisTexts::given() const {
  if (theta) return "--theta";
  return decimate ? "--decimate" : "";
}

VoronoiAxisOptions parse_axis_options(const VoronoiAxisTexts& texts) {
  VoronoiAxisOptions out;
  if (texts.theta) out.theta = parse_angle("--theta", *texts.theta);
  if (texts.decimate) out.decimate = parse_non_negative("--decimate", *texts.decimate);
  out.graph = parse_graph(texts.graph);
  if (texts.patch_angle || texts.patch_fit) out.patches.emplace();
  if (texts.patch_angle) out.patches->patch_angle = parse_angle("--patch-angle", *texts.patch_angle);
  if (texts.patch_fit) out.patches->patch_fit = parse_positive("--patch-fit", *texts.patch_fit);
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

Json add_graph(VoronoiAxis& out, const Complex& axis, const SolidInput& input, const VoronoiAxisOptions& options,
               const MedialMetadata& metadata, const Context& context) {
  if (!options.graph) return nullptr;
  Stopwatch watch;
  AxisGraphOptions how;
  how.homotopy_angle = options.theta;
  how.of_patches = options.patches.has_value();
  if (options.patches) {
    how.patch_angle = options.patches->patch_angle;
    how.patch_fit = options.patches->patch_fit;
  }
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
  Complex whole = collapse_axis(walls, options.theta, context);
  out.phases.push_back({"collapse", watch.lap()});
  out.drafts.emplace_back(output);
  const SolidVerifier verifier(input);
  const auto certify = [&](const AxisCandidate& axis) {
    Stopwatch writing;
    const fs::path& draft = out.drafts.front().path();
    write_medial(draft, axis.axis.axis, axis.metadata, context);
    axis.phases.push_back({"write", writing.lap()});
    Certificate certificate = verifier.certificate_of(draft, axis.metadata, {}, context);
    axis.phases.push_back({"certificate", writing.lap()});
    return certificate;
  };
  const CertifiedAxis made = certified_axis(std::move(whole), metadata_of(options, source, weld), options.decimate,
                                            certify, out.phases, context);
  const MedialCounts counts = count(made.axis.axis);
  out.warnings = made.warnings;
  const double size = size_of(input, {}, context);
  out.mismatches = made.certificate.mismatches;
  add_certificate(out.table, " (the axis)", made.certificate, false, size);
  add_axis_counts(out.table, "", counts, true);
  add_decimated(out.table, made, size);
  out.json = {{"theta", options.theta},
              {"counts", counts_json(counts, true)},
              {"deviation", made.axis.deviation},
              {"vertices_before", made.axis.vertices_before},
              {"graph", add_graph(out, made.axis.axis, input, options, made.metadata, context)},
              {"certificate", certificate_json(made.certificate, false)}};
  return out;
}

}  // namespace blum::cli
